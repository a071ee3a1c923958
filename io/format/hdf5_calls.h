// What the readers and writers of HDF5 share: checked calls of the C library. Only the hdf5*.cc
// files include this.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

#include "io/format/hdf5.h"

namespace strut::hdf5 {

static_assert(sizeof(hid_t) == sizeof(Hdf5Handle::Id), "handles carry an hid_t");

/// Before the first call of the library.
void prepare_library();

/// What the library says went wrong last, " (...)"; empty where it says nothing.
std::string take_library_error();

/// Throws the EnvironmentError of a call that should have written: for the user the system's reason
/// where the library names one, as for a full disk, else `what` failed.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& object,
                                const std::string& what);

template <class Error>
void check(bool good, const std::filesystem::path& path, const std::string& object,
           const std::string& what) {
  if (good) return;
  if constexpr (std::is_same_v<Error, EnvironmentError>) fail_to_write(path, object, what);
  throw Error(path.string() + (object.empty() ? "" : ": " + object) + ": " + what +
              take_library_error());
}

template <class Error>
Hdf5Handle checked(hid_t id, Hdf5Handle::Close close, const std::filesystem::path& path,
                   const std::string& object, const std::string& what) {
  check<Error>(id >= 0, path, object, what);
  return {id, close};
}

/// Type of the elements, in memory as in the file.
Hdf5Handle make_type(const std::filesystem::path& path, Hdf5Type type, std::size_t text_length);

/// `count` whole rows of a dataset of `shape`, from row `first` on.
template <class Error>
Hdf5Handle select_rows(const std::filesystem::path& path, const std::string& name,
                       const std::vector<std::size_t>& shape, std::size_t first,
                       std::size_t count) {
  const std::string what = "rows cannot be selected";
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  Hdf5Handle space =
      checked<Error>(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                     H5Sclose, path, name, what);
  std::vector<hsize_t> start(shape.size(), 0);
  std::vector<hsize_t> block = sizes;
  start.front() = first;
  block.front() = count;
  check<Error>(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                                   nullptr) >= 0,
               path, name, what);
  return space;
}

/// Access by name that never leaves the file: what an external link points to counts as missing.
/// Serves as the access list of links and of datasets.
hid_t stay_in_file();

/// File access: the format of 1.10, which has checksums over all of its own structures.
Hdf5Handle make_file_access(const std::filesystem::path& path);
/// File creation without times, so that equal content is equal bytes; `sealed`: with room for a
/// seal in front.
Hdf5Handle make_file_creation(const std::filesystem::path& path, bool sealed);

/// Dataset creation: fill value NaN, -1 or an empty text, no times.
Hdf5Handle make_dataset_creation(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                                 std::size_t text_length);
void set_chunks(const Hdf5Sink& sink, const std::string& name, hid_t creation,
                const std::vector<std::size_t>& shape, std::size_t chunk_rows);

/// A new dataset with its label; groups on the way are made as needed.
Hdf5Handle create_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                          std::size_t text_length, const std::vector<std::size_t>& shape,
                          hid_t creation, const Hdf5Label& label);
/// As above, plain, with values.
void write_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Type type,
                   std::size_t text_length, const std::vector<std::size_t>& shape,
                   const void* values, const Hdf5Label& label);
/// Stores chunk number `chunk` as it is.
void write_chunk(const Hdf5Sink& sink, const std::string& name, hid_t dataset, std::size_t rank,
                 std::size_t first_row, std::span<const std::byte> bytes);
/// Closes, which may write.
void close_dataset(const Hdf5Sink& sink, const std::string& name, Hdf5Handle& dataset);

/// Attribute `key` of an object that messages call `object_name`; `scalar`: a single text.
void write_texts(const std::filesystem::path& path, hid_t object, const std::string& object_name,
                 const std::string& key, const std::vector<std::string>& values, bool scalar);
/// Empty where there is none. Throws InputError.
std::vector<std::string> read_texts_of(const std::filesystem::path& path, hid_t object,
                                       const std::string& object_name, const std::string& key);
/// Bytes of a text of `type`, which must be one of fixed length: the library crashes on damaged
/// texts of variable length.
std::size_t get_text_length(const std::filesystem::path& path, const std::string& name, hid_t type);
/// Texts of one length, each up to its first zero.
std::vector<std::string> unpack_texts(const std::vector<char>& raw, std::size_t length);

void write_text_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                          const std::vector<std::string>& values, bool scalar);
void write_number_attribute(const Hdf5Sink& sink, const std::string& object, const std::string& key,
                            hid_t type, const void* value);

/// A name for a file in memory that no other open file has; the library would take files of one
/// name for the same.
std::string make_memory_name();

}  // namespace strut::hdf5
