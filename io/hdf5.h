// A checked layer over the HDF5 C library: every failing call is an exception that names file and
// dataset, every handle is closed, and the library's own printing of errors is off.
//
// Files read in other tools without help (`h5dump`, h5py, MATLAB): doubles in native order, strings
// as UTF-8 of variable length. Every dataset carries the attributes `unit`, `description` and, if
// it has columns, `names`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "io/input_error.h"

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
  std::vector<std::string> names;  // of the columns of a 2-D dataset; may be empty
};

struct Hdf5Dataset {
  std::vector<std::size_t> shape;  // one or two dimensions
  std::vector<double> values;      // row by row
  Hdf5Label label;
};

/// Writes one file, which appears under its name at `commit` or not at all. Failures are
/// EnvironmentError.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path);

  /// 1-D dataset. Groups in `name` ("/history/pitch_rate") are made as needed.
  void write(const std::string& name, std::span<const double> values, const Hdf5Label& label);
  /// 2-D dataset, `values` row by row; values.size() must be a multiple of `columns`.
  void write(const std::string& name, std::span<const double> values, std::size_t columns,
             const Hdf5Label& label);
  /// Attribute of the dataset or group `object` ("/": the file).
  void write_attribute(const std::string& object, const std::string& key, const std::string& value);

  void commit();

 private:
  void write_shaped(const std::string& name, std::span<const double> values,
                    const std::vector<std::size_t>& shape, const Hdf5Label& label);

  AtomicFile target_;
  Hdf5Handle file_;
};

/// Reads a file. A missing file, one that is not HDF5, and a missing or damaged dataset are
/// InputError.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);

  bool has(const std::string& name) const;
  Hdf5Dataset read(const std::string& name) const;
  std::string read_attribute(const std::string& object, const std::string& key) const;
  /// Names of the datasets and groups in `group`, sorted.
  std::vector<std::string> list(const std::string& group) const;

 private:
  std::filesystem::path path_;
  Hdf5Handle file_;
};

/// Version of the HDF5 library in use, "1.10.8".
std::string hdf5_version();

}  // namespace strut
