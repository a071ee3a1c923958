// A checked layer over the HDF5 C library: every failing call is an exception that names file and
// dataset, every handle is closed, and the library's own printing of errors is off.
//
// Files read in other tools without help (`h5dump`, h5py, MATLAB): numbers in native order, texts
// as UTF-8 of fixed length, padded by zeros, also those of attributes. Texts of variable length
// would lie in global heaps, the one structure of the format that has no checksum: a flipped bit
// there ends a program in the library. Every dataset carries the attributes `unit`, `description`
// and, if it has columns, `names`.
//
// The library takes one lock around everything: call it from one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/atomic_file.h"
#include "io/file/file_seal.h"

namespace strut {

/// An HDF5 identifier and the call that closes it.
class Hdf5Handle {
 public:
  using Id = std::int64_t;
  using Close = int (*)(Id);

  Hdf5Handle() = default;
  Hdf5Handle(Id id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept;
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;

  Id id() const { return id_; }
  /// Closes now; false where the library reports a failure.
  bool reset();

 private:
  Id id_ = -1;
  Close close_ = nullptr;
};

/// What a dataset means.
struct Hdf5Label {
  std::string unit;
  std::string description;
  std::vector<std::string> names;              // of the columns of a 2-D dataset; may be empty
  std::vector<std::string> units = {};         // of the columns, where they differ
  std::vector<std::string> descriptions = {};  // of the columns
};

enum class Hdf5Type { kDouble, kInt32, kInt64, kText };

/// Bytes of one element; `text_length` counts for texts only.
std::size_t get_element_size(Hdf5Type type, std::size_t text_length);

/// Hdf5Type of a C++ type.
template <class T>
inline constexpr Hdf5Type hdf5_type = Hdf5Type::kDouble;
template <>
inline constexpr Hdf5Type hdf5_type<std::int32_t> = Hdf5Type::kInt32;
template <>
inline constexpr Hdf5Type hdf5_type<std::int64_t> = Hdf5Type::kInt64;
template <>
inline constexpr Hdf5Type hdf5_type<std::string> = Hdf5Type::kText;

/// Texts of one length, one behind the other, padded with zeros.
struct PackedTexts {
  std::size_t length = 1;  // of the longest
  std::vector<std::byte> bytes;
};

PackedTexts pack_texts(std::span<const std::string> texts, std::size_t at_least = 1);

/// A dataset whose chunks were compressed elsewhere, see io/file/compress.h. Chunks are whole rows;
/// the last is as long as the others, padded.
struct Hdf5Chunks {
  std::string name;  // "/snapshot"
  Hdf5Type type = Hdf5Type::kDouble;
  std::vector<std::size_t> shape;
  std::size_t chunk_rows = 0;
  std::vector<std::vector<std::byte>> chunks;
  std::size_t text_length = 0;  // kText: bytes of a text
  Hdf5Label label;
};

struct Hdf5Dataset {
  std::vector<std::size_t> shape;  // one or two dimensions
  std::vector<double> values;      // row by row
  Hdf5Label label;
};

struct Hdf5WriterOptions {
  std::optional<SealLabel> seal = {};  // none: a plain HDF5 file
};

/// A file that is not to be written to disk; the name stands in messages.
struct Hdf5InMemory {
  std::string name;
};

/// An open file of a writer, and how messages call it.
struct Hdf5Sink {
  std::filesystem::path shown;
  Hdf5Handle file;
};

/// Writes one file, which appears under its name at `commit` or not at all. It is built in memory,
/// so that the library, which loses chunks on a full disk and reports success, never sees one.
/// Failures are EnvironmentError.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path, const Hdf5WriterOptions& options = {});
  /// Inside a folder that strut makes.
  Hdf5Writer(const Folder& folder, const std::string& name, const Hdf5WriterOptions& options = {});
  explicit Hdf5Writer(const Hdf5InMemory& memory, const Hdf5WriterOptions& options = {});
  ~Hdf5Writer();

  /// 1-D dataset. Groups in `name` ("/history/pitch_rate") are made as needed.
  void write(const std::string& name, std::span<const double> values, const Hdf5Label& label);
  void write(const std::string& name, std::span<const std::int32_t> values, const Hdf5Label& label);
  void write(const std::string& name, std::span<const std::int64_t> values, const Hdf5Label& label);
  void write(const std::string& name, const std::vector<std::string>& values,
             const Hdf5Label& label);
  /// 2-D dataset, `values` row by row; values.size() must be a multiple of `columns`.
  void write(const std::string& name, std::span<const double> values, std::size_t columns,
             const Hdf5Label& label);
  void write_chunks(const Hdf5Chunks& dataset);

  /// Attribute of the dataset or group `object` ("/": the file).
  void write_attribute(const std::string& object, const std::string& key, const std::string& value);
  void write_attribute(const std::string& object, const std::string& key, std::int64_t value);
  void write_attribute(const std::string& object, const std::string& key, double value);
  void write_attribute_list(const std::string& object, const std::string& key,
                            const std::vector<std::string>& values);

  /// Ends the file; its bytes, sealed. Nothing can be written any more.
  std::vector<std::byte> image();
  void commit();

 private:
  struct Memory;

  void open(const Hdf5WriterOptions& options);

  std::optional<AtomicFile> target_;
  std::optional<SealLabel> seal_;
  std::unique_ptr<Memory> memory_;
  Hdf5Sink sink_;
};

/// Reads a file. A missing file, one that is not HDF5, and a missing or damaged dataset are
/// InputError, and so is one whose values lie in other files: no seal covers those.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  /// Reads a file of `kind` into memory, checks its seal, and opens those very bytes. A file of an
  /// earlier version, which has no seal, is opened as it is.
  Hdf5Reader(const std::filesystem::path& path, const SealKind& kind);
  /// Opens a file that an earlier version wrote, without a seal, unless it is a view.
  static Hdf5Reader open_unsealed(const std::filesystem::path& path);
  /// Reads the bytes of a file; `path` stands in messages.
  Hdf5Reader(const std::filesystem::path& path, std::span<const std::byte> image);

  bool has(const std::string& name) const;
  Hdf5Dataset read(const std::string& name) const;
  /// Rows [first, first + count). Reading blocks of whole chunks decompresses each chunk once.
  Hdf5Dataset read_rows(const std::string& name, std::size_t first, std::size_t count) const;
  std::vector<std::int64_t> read_integers(const std::string& name) const;
  /// As read_rows, of a dataset of integers.
  std::vector<std::int64_t> read_integer_rows(const std::string& name, std::size_t first,
                                              std::size_t count) const;
  /// A dataset of texts of fixed length.
  std::vector<std::string> read_texts(const std::string& name) const;
  /// Bytes of each of them.
  std::size_t read_text_length(const std::string& name) const;
  Hdf5Label read_label(const std::string& name) const;
  std::vector<std::size_t> read_shape(const std::string& name) const;
  /// Rows of a chunk; all rows where the dataset is not chunked.
  std::size_t read_chunk_rows(const std::string& name) const;

  bool has_attribute(const std::string& object, const std::string& key) const;
  std::string read_attribute(const std::string& object, const std::string& key) const;
  /// Empty where there is none.
  std::vector<std::string> read_attribute_list(const std::string& object,
                                               const std::string& key) const;
  std::int64_t read_integer_attribute(const std::string& object, const std::string& key) const;
  double read_number_attribute(const std::string& object, const std::string& key) const;
  /// Names of the attributes of `object`, sorted.
  std::vector<std::string> list_attributes(const std::string& object) const;
  /// Names of the datasets and groups in `group`, sorted.
  std::vector<std::string> list(const std::string& group) const;

 private:
  Hdf5Handle open_dataset(const std::string& name) const;

  std::filesystem::path path_;
  Hdf5Handle file_;
};

/// Version of the HDF5 library in use, "1.10.8".
std::string hdf5_version();

}  // namespace strut
