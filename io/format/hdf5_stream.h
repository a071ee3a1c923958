// Writes sealed HDF5 files that do not fit in memory, block by block.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/format/hdf5.h"

namespace strut {

/// Writes one file, which appears under its name at `commit` or not at all; its datasets have known
/// shapes and are filled from the first row on. Chunks are compressed here and passed to the
/// library whole, so that a full disk fails the call that meets it; every call is checked,
/// including those that close. Memory: one chunk per dataset. Failures are EnvironmentError.
class Hdf5StreamWriter {
 public:
  Hdf5StreamWriter(const std::filesystem::path& path, SealLabel seal);
  Hdf5StreamWriter(const Hdf5StreamWriter&) = delete;
  Hdf5StreamWriter& operator=(const Hdf5StreamWriter&) = delete;

  /// Creates a dataset of shape[0] rows. `text_length` applies to texts only.
  void create(const std::string& name, Hdf5Type type, const std::vector<std::size_t>& shape,
              const Hdf5Label& label, std::size_t text_length = 0);
  /// Appends whole rows to a dataset made by `create`, in its type, texts padded to its length.
  /// Throws CheckError if they do not fit.
  void append(const std::string& name, std::span<const std::byte> bytes);
  template <class T>
  void append(const std::string& name, const std::vector<T>& values) {
    append(name, std::as_bytes(std::span(values)));
  }

  void write_attribute(const std::string& object, const std::string& key, const std::string& value);
  void write_attribute(const std::string& object, const std::string& key, std::int64_t value);
  void write_attribute(const std::string& object, const std::string& key, double value);
  void write_attribute_list(const std::string& object, const std::string& key,
                            const std::vector<std::string>& values);

  /// Writes names for the values of a dimension: texts of variable length, since netCDF has no
  /// others of one dimension. Hdf5Reader refuses to read them.
  void write_names(const std::string& name, const std::vector<std::string>& names,
                   const std::string& description);
  /// Makes a scale without values, netCDF's dimension without a variable.
  void create_dimension(const std::string& name, std::size_t size);
  /// As Hdf5Writer::attach_scale.
  void attach_scale(const std::string& scale, unsigned dimension,
                    const std::vector<std::string>& datasets);

  /// Reads the file back for its seal and gives it its name. Throws CheckError if a dataset lacks
  /// rows.
  void commit();

 private:
  struct Stream {
    Hdf5Handle dataset;
    std::size_t rank = 1, rows = 0;
    std::size_t element_bytes = 0, row_bytes = 0, chunk_rows = 0;
    std::size_t written_rows = 0;    // whole chunks
    std::vector<std::byte> pending;  // less than a chunk
  };

  void write_chunk(const std::string& name, Stream& stream);

  AtomicFile target_;
  SealLabel seal_;
  Hdf5Sink sink_;
  std::map<std::string, Stream> streams_;
};

}  // namespace strut
