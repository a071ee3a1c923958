// Reads measured channels as columns of one file of any format: text (io/table/csv.h), HDF5
// (io/store/hdf5_table.h), MATLAB (io/table/mat_file.h).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/store/hdf5_table.h"
#include "io/store/shard.h"
#include "io/table/table_file.h"
#include "io/table/units.h"

namespace strut {

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
  std::vector<int> lines;          // text: line in the file of each row; otherwise empty
  std::vector<ColumnConversion> conversions;  // by column; empty: as in the file
  std::vector<std::string> notes;             // for the user: what was left out or assumed

  std::size_t row_count() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Returns nullptr if there is no such column.
  const CsvColumn* find(const std::string& name) const;
  /// Returns the values of a column that must exist.
  const std::vector<double>& values(const std::string& name) const;
  /// Returns how a column that must exist was converted; read_channels says so of its own.
  const ColumnConversion& conversion(const std::string& name) const;
  /// Returns the location of a row for messages: "drive.csv:12", or "drive.h5: row 11" (from 0).
  std::string locate(std::size_t row) const;
};

/// Opens a file of any format.
std::unique_ptr<TableFile> open_table_file(const std::filesystem::path& path, MeasuredPart part,
                                           MissingCells missing = MissingCells::kNan);

/// Reads the requested columns. Throws InputError, with file, column and line or row, for a missing
/// required column (with the nearest name and all names), a value that is not finite (infinite, if
/// values may be missing), columns of different lengths, or no rows.
Measurement read_measurement(const std::filesystem::path& path, const MeasurementRequest& request);

}  // namespace strut
