// Measured channels as columns of one file, from CSV or HDF5.
//
// CSV: as io/format/csv.h reads it. HDF5, by the name's end (.h5, .hdf5): what `strut simulate` and
// `strut run` write (/snapshot/NAME, /history/NAME, the table /snapshot of a shard or a merged
// file), or a one-dimensional dataset /NAME per column, as other tools write them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/format/csv.h"
#include "io/store/shard.h"

namespace strut {

/// Which of a file's two tables is meant; a CSV file, and an HDF5 file with its columns at the top,
/// has only one.
enum class MeasuredPart { kSnapshot, kHistory };

struct MeasurementRequest {
  std::vector<std::string> required;
  std::vector<std::string> optional = {};  // read where they are there
  MeasuredPart part = MeasuredPart::kSnapshot;
  /// kNan: values may be missing, NaN in the result.
  MissingCells missing = MissingCells::kRefused;
};

/// Values finite unless they may be missing; all columns are of one length, one row or more.
struct Measurement {
  std::filesystem::path path;
  std::vector<CsvColumn> columns;  // those asked for that are there, in the order of the request
  std::vector<int> lines;          // CSV: line in the file of each row; else empty

  std::size_t row_count() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// nullptr where it is not there.
  const CsvColumn* find(const std::string& name) const;
  /// One that is there.
  const std::vector<double>& values(const std::string& name) const;
  /// For messages: "drive.csv:12", or "drive.h5: row 11" (the first is 0).
  std::string locate(std::size_t row) const;
};

/// Throws InputError that names the file and, where there is one, the column and the line or row: a
/// required column that is not there (with the nearest name and all there are), a value that is not
/// finite (infinite, where values may be missing), columns of different lengths, no rows.
Measurement read_measurement(const std::filesystem::path& path, const MeasurementRequest& request);

/// Throws InputError where a column of `expected`, which is there, names another unit.
void require_units(const Measurement& measurement, const std::vector<ColumnInfo>& expected);

}  // namespace strut
