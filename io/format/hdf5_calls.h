// Checked calls of the HDF5 library, shared by readers and writers. Only the hdf5*.cc files include
// this.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

#include "io/format/hdf5.h"

namespace strut::hdf5 {

static_assert(sizeof(hid_t) == sizeof(Hdf5Handle::Id), "handles carry an hid_t");

/// Must precede the first call of the library.
void prepare_library();

/// Throws the InputError "PATH: OBJECT: WHAT (the library's reason)"; `object` may be empty.
[[noreturn]] void fail_to_read(const std::filesystem::path& path, const std::string& object,
                               const std::string& what);

/// Throws the EnvironmentError of a failed write: with the system's reason if the library names
/// one, as for a full disk, else "PATH: OBJECT: WHAT".
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& object,
                                const std::string& what);

inline constexpr char kDamaged[] = "damaged";

template <class Error>
void check(bool good, const std::filesystem::path& path, const std::string& object,
           const std::string& what) {
  if (good) return;
  if constexpr (std::is_same_v<Error, EnvironmentError>) fail_to_write(path, object, what);
  fail_to_read(path, object, what);
}

template <class Error>
Hdf5Handle checked(hid_t id, Hdf5Handle::Close close, const std::filesystem::path& path,
                   const std::string& object, const std::string& what) {
  check<Error>(id >= 0, path, object, what);
  return {id, close};
}

/// Returns the type of the elements, in memory and in the file.
Hdf5Handle make_type(const std::filesystem::path& path, Hdf5Type type, std::size_t text_length);

/// Returns an access list, for links and datasets, that does not follow external links: their
/// targets count as missing.
hid_t get_in_file_access();

/// Returns file access in the format of 1.10, which has checksums over all of its own structures.
Hdf5Handle make_file_access(const std::filesystem::path& path);
/// Returns file creation without times, so that equal content is equal bytes; `user_block`:
/// with room for a seal at the start.
Hdf5Handle make_file_creation(const std::filesystem::path& path, bool user_block);

/// Returns dataset creation with the fill value NaN, -1 or an empty text, without times.
Hdf5Handle make_dataset_creation(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                                 std::size_t text_length);
void set_chunks(const Hdf5Sink& sink, const std::string& name, hid_t creation,
                const std::vector<std::size_t>& shape, std::size_t chunk_rows);

/// Creates a dataset with its label, and the groups on the way to it.
Hdf5Handle create_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                          std::size_t text_length, const std::vector<std::size_t>& shape,
                          hid_t creation, const Hdf5Label& label);
/// Creates a dataset that is not chunked and writes its values.
void write_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                   std::size_t text_length, const std::vector<std::size_t>& shape,
                   const void* values, const Hdf5Label& label);
/// Stores the compressed chunk that begins at row `first_row`.
void write_chunk(const Hdf5Sink& sink, const std::string& name, hid_t dataset, std::size_t rank,
                 std::size_t first_row, std::span<const std::byte> bytes);
/// Closes a dataset, which may write to the file.
void close_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Handle& dataset);

/// Writes attribute `key` of an object that messages call `object_name`; `scalar`: a single text.
void write_texts(const std::filesystem::path& path, hid_t object, const std::string& object_name,
                 const std::string& key, const std::vector<std::string>& values, bool scalar);
/// Whether an object has an attribute that holds texts of variable length.
bool has_variable_text(hid_t object, const std::string& key);
/// Reads a text attribute; empty if there is none. Throws InputError.
std::vector<std::string> read_texts_of(const std::filesystem::path& path, hid_t object,
                                       const std::string& object_name, const std::string& key);
/// Returns the bytes of a text of `type`. Throws InputError unless its length is fixed: the library
/// crashes on damaged texts of variable length.
std::size_t get_text_length(const std::filesystem::path& path, const std::string& name, hid_t type);
/// Splits texts of equal length, each of which ends at its first zero.
std::vector<std::string> unpack_texts(const std::vector<char>& raw, std::size_t length);

void write_text_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                          const std::vector<std::string>& values, bool scalar);
/// Writes texts of variable length, which strut itself never reads.
void write_variable_texts(const Hdf5Sink& sink, const std::string& name,
                          const std::vector<std::string>& texts, const Hdf5Label& label);
/// Makes a dimension scale without values.
void create_dimension(const Hdf5Sink& sink, const std::string& name, std::size_t size);
/// Makes `scale`, a dataset of one dimension, a dimension scale and attaches it to a dimension of
/// `datasets`: tools show their values over those of the scale.
void attach_scale(const Hdf5Sink& sink, const std::string& scale, unsigned dimension,
                  const std::vector<std::string>& datasets);

void write_number_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                            hid_t type, const void* value);

/// Returns a name for a file in memory that no other open file has: the library identifies open
/// files by name.
std::string make_memory_name();

}  // namespace strut::hdf5
