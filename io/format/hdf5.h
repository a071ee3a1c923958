// A checked layer over the HDF5 C library: every failing call is an exception that names file and
// dataset, every handle is closed, and the library's own printing of errors is off.
//
// The files can be read directly by other tools (`h5dump`, h5py, MATLAB): numbers in native order;
// texts, including those of attributes, as zero-padded UTF-8 of fixed length. Texts of variable
// length would lie in global heaps, the one structure of the format without a checksum: a flipped
// bit there crashes the library. Every dataset carries the attributes `unit`, `description` and, if
// it has columns, `names`.
//
// One global lock guards the library: call it from one thread.
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
  /// Closes now; false if the library reports a failure.
  bool reset();

 private:
  Id id_ = -1;
  Close close_ = nullptr;
};

/// Unit and meaning of a dataset and its columns.
struct Hdf5Label {
  std::string unit;
  std::string description;
  std::vector<std::string> names;              // columns of a 2-D dataset; may be empty
  std::vector<std::string> units = {};         // by column, where they differ
  std::vector<std::string> descriptions = {};  // by column
};

enum class Hdf5Type { kDouble, kInt32, kInt64, kText };

/// Returns the bytes of one element; `text_length` applies to texts only.
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

/// Texts of equal length, zero-padded, without gaps.
struct PackedTexts {
  std::size_t length = 1;  // bytes of the longest
  std::vector<std::byte> bytes;
};

PackedTexts pack_texts(std::span<const std::string> texts, std::size_t min_length = 1);

/// A dataset with compressed chunks (io/file/compress.h). Chunks are whole rows; the last is padded
/// to the length of the others.
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

/// A file that is not written to disk; messages call it `name`.
struct Hdf5InMemory {
  std::string name;
};

/// An open file of a writer, which messages call `shown`.
struct Hdf5Sink {
  std::filesystem::path shown;
  Hdf5Handle file;
};

/// Writes one file, which appears under its name at `commit` or not at all. It is built in memory,
/// since on a full disk the library loses chunks and reports success. Failures are
/// EnvironmentError.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path, const Hdf5WriterOptions& options = {});
  /// Writes inside a folder that strut makes.
  Hdf5Writer(const Folder& folder, const std::string& name, const Hdf5WriterOptions& options = {});
  explicit Hdf5Writer(const Hdf5InMemory& memory, const Hdf5WriterOptions& options = {});
  ~Hdf5Writer();

  /// Writes a 1-D dataset. Groups in `name` ("/history/pitch_rate") are made as needed.
  void write(const std::string& name, std::span<const double> values, const Hdf5Label& label);
  void write(const std::string& name, std::span<const std::int32_t> values, const Hdf5Label& label);
  void write(const std::string& name, std::span<const std::int64_t> values, const Hdf5Label& label);
  void write(const std::string& name, const std::vector<std::string>& values,
             const Hdf5Label& label);
  /// Writes a 2-D dataset, `values` row by row; values.size() must be a multiple of `columns`.
  void write(const std::string& name, std::span<const double> values, std::size_t columns,
             const Hdf5Label& label);
  void write_chunks(const Hdf5Chunks& dataset);

  /// Writes an attribute of the dataset or group `object` ("/": the file).
  void write_attribute(const std::string& object, const std::string& key, const std::string& value);
  void write_attribute(const std::string& object, const std::string& key, std::int64_t value);
  void write_attribute(const std::string& object, const std::string& key, double value);
  void write_attribute_list(const std::string& object, const std::string& key,
                            const std::vector<std::string>& values);
  /// Makes `scale`, a dataset of one dimension, the axis of a dimension of `datasets` (a dimension
  /// scale, as netCDF-4 has them).
  void attach_scale(const std::string& scale, unsigned dimension,
                    const std::vector<std::string>& datasets);

  /// Completes the file and returns its bytes, sealed. Must be the last call.
  std::vector<std::byte> image();
  void commit();

 private:
  struct Memory;

  void open(const Hdf5WriterOptions& options);
  bool has_user_block() const { return seal_ && !seal_->kind.is_last; }

  std::optional<AtomicFile> target_;
  std::optional<SealLabel> seal_;
  std::unique_ptr<Memory> memory_;
  Hdf5Sink sink_;
};

/// What a name in a file stands for.
enum class Hdf5Kind { kGroup, kNumbers, kOther };

/// Reads a file. Throws InputError for a missing file, one that is not HDF5, a missing or damaged
/// dataset, and a dataset whose values lie in other files, since no seal covers those.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  /// Reads a file of `kind` into memory, checks its seal, and opens those very bytes. A file
  /// without a seal, from an earlier version, is opened by open_unsealed().
  Hdf5Reader(const std::filesystem::path& path, const SealKind& kind);
  /// Opens a file without a seal, from an earlier version. Throws InputError if it is a view.
  static Hdf5Reader open_unsealed(const std::filesystem::path& path);
  /// Reads the bytes of a file that messages call `path`.
  Hdf5Reader(const std::filesystem::path& path, std::span<const std::byte> image);

  bool has(const std::string& name) const;
  /// kNumbers: a dataset of one or two dimensions of integers or floating-point numbers.
  Hdf5Kind find_kind(const std::string& name) const;
  Hdf5Dataset read(const std::string& name) const;
  /// Reads rows [first, first + count). Blocks of whole chunks decompress each chunk once.
  Hdf5Dataset read_rows(const std::string& name, std::size_t first, std::size_t count) const;
  std::vector<std::int64_t> read_integers(const std::string& name) const;
  /// As read_rows, for a dataset of integers.
  std::vector<std::int64_t> read_integer_rows(const std::string& name, std::size_t first,
                                              std::size_t count) const;
  /// Reads a dataset of texts of fixed length.
  std::vector<std::string> read_texts(const std::string& name) const;
  /// Returns the bytes of each text of a dataset.
  std::size_t read_text_length(const std::string& name) const;
  Hdf5Label read_label(const std::string& name) const;
  std::vector<std::size_t> read_shape(const std::string& name) const;
  /// Returns the rows per chunk; all rows if the dataset is not chunked.
  std::size_t read_chunk_rows(const std::string& name) const;

  bool has_attribute(const std::string& object, const std::string& key) const;
  std::string read_attribute(const std::string& object, const std::string& key) const;
  /// Returns an empty list if there is no such attribute.
  std::vector<std::string> read_attribute_list(const std::string& object,
                                               const std::string& key) const;
  std::int64_t read_integer_attribute(const std::string& object, const std::string& key) const;
  double read_number_attribute(const std::string& object, const std::string& key) const;
  /// Returns the names of the attributes of `object`, sorted.
  std::vector<std::string> list_attributes(const std::string& object) const;
  /// Returns the names of the datasets and groups in `group`, sorted.
  std::vector<std::string> list(const std::string& group) const;

 private:
  Hdf5Handle open_dataset(const std::string& name) const;

  std::filesystem::path path_;
  Hdf5Handle file_;
};

/// Returns the version of the HDF5 library in use, "1.10.8".
std::string hdf5_version();

}  // namespace strut
