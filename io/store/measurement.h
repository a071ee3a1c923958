// Reads measured channels as columns of one CSV or HDF5 file.
//
// CSV: see io/format/csv.h. HDF5, recognized by the extension (.h5, .hdf5): the files of `strut
// simulate` and `strut run` (/snapshot/NAME, /history/NAME, the table /snapshot of a shard or a
// merged file), or a one-dimensional dataset /NAME per column, as other tools write them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/format/csv.h"
#include "io/store/shard.h"

namespace strut {

/// Table of the file to read; a CSV file, and an HDF5 file with its columns at the top level, has
/// only one.
enum class MeasuredPart { kSnapshot, kHistory };

struct MeasurementRequest {
  std::vector<std::string> required;
  std::vector<std::string> optional = {};  // read if the file has them
  MeasuredPart part = MeasuredPart::kSnapshot;
  /// kNan: values may be missing, NaN in the result.
  MissingCells missing = MissingCells::kRefused;
};

/// All values are finite unless they may be missing; all columns have the same length, one row or
/// more.
struct Measurement {
  std::filesystem::path path;
  std::vector<CsvColumn> columns;  // requested columns that exist, in the order of the request
  std::vector<int> lines;          // CSV: line in the file of each row; otherwise empty

  std::size_t row_count() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Returns nullptr if there is no such column.
  const CsvColumn* find(const std::string& name) const;
  /// Returns the values of a column that must exist.
  const std::vector<double>& values(const std::string& name) const;
  /// Returns the location of a row for messages: "drive.csv:12", or "drive.h5: row 11" (from 0).
  std::string locate(std::size_t row) const;
};

/// Reads the requested columns. Throws InputError, with file, column and line or row, for a missing
/// required column (with the nearest name and all names), a value that is not finite (infinite, if
/// values may be missing), columns of different lengths, or no rows.
Measurement read_measurement(const std::filesystem::path& path, const MeasurementRequest& request);

/// Throws InputError if a column of `expected`, all of which must exist, has another unit.
void require_units(const Measurement& measurement, const std::vector<ColumnInfo>& expected);

}  // namespace strut
