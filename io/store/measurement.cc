#include "io/store/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "io/table/mat_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

void take_columns(const MeasurementRequest& request, const TableFile& file,
                  Measurement& measurement) {
  const auto take = [&](const std::string& name) {
    measurement.columns.push_back(file.read(name));
    measurement.columns.back().name = name;
  };
  for (const std::string& name : request.required) take(name);
  for (const std::string& name : request.optional) {
    if (file.has(name)) take(name);
  }
}

void check_length(const Measurement& measurement, const CsvColumn& column) {
  if (column.values.size() == measurement.row_count()) return;
  throw InputError(fmt::format("{}: column '{}' has {} values, '{}' {}; must be of one length",
                               measurement.path.string(), column.name, column.values.size(),
                               measurement.columns.front().name, measurement.row_count()));
}

void check_finite(const Measurement& measurement, const CsvColumn& column, MissingCells missing) {
  const bool is_complete = missing == MissingCells::kRefused;
  const auto bad = std::find_if(column.values.begin(), column.values.end(), [&](double x) {
    return is_complete ? !std::isfinite(x) : std::isinf(x);
  });
  if (bad == column.values.end()) return;
  const auto row = static_cast<std::size_t>(bad - column.values.begin());
  throw InputError(fmt::format("{}: {} is not finite", measurement.locate(row), column.name));
}

void check_columns(const Measurement& measurement, MissingCells missing) {
  for (const CsvColumn& column : measurement.columns) {
    check_length(measurement, column);
    check_finite(measurement, column, missing);
  }
  if (!measurement.columns.empty() && measurement.row_count() == 0) {
    throw InputError(measurement.path.string() + ": no rows");
  }
}

}  // namespace

const CsvColumn* Measurement::find(const std::string& name) const {
  const auto at = std::find_if(columns.begin(), columns.end(),
                               [&](const CsvColumn& column) { return column.name == name; });
  return at == columns.end() ? nullptr : &*at;
}

const std::vector<double>& Measurement::values(const std::string& name) const {
  const CsvColumn* column = find(name);
  STRUT_CHECK(column != nullptr, "Measurement: no column " + name);
  return column->values;
}

const ColumnConversion& Measurement::conversion(const std::string& name) const {
  const CsvColumn* column = find(name);
  STRUT_CHECK(column != nullptr && conversions.size() == columns.size(),
              "Measurement: no conversion of " + name);
  return conversions[static_cast<std::size_t>(column - columns.data())];
}

std::string Measurement::locate(std::size_t row) const {
  if (row < lines.size()) return fmt::format("{}:{}", path.string(), lines[row]);
  return fmt::format("{}: row {}", path.string(), row);
}

std::unique_ptr<TableFile> open_table_file(const fs::path& path, MeasuredPart part,
                                           MissingCells missing) {
  switch (find_table_format(path)) {
    case TableFormat::kHdf5:
      return open_hdf5_table(path, part);
    case TableFormat::kMatlab5:
      return open_mat_file(path);
    case TableFormat::kText:
      break;
  }
  return std::make_unique<TextTableFile>(path, missing);
}

Measurement read_measurement(const fs::path& path, const MeasurementRequest& request) {
  Measurement measurement;
  measurement.path = path;
  const auto file = open_table_file(path, request.part, request.missing);
  measurement.lines = file->lines();
  measurement.notes = file->notes();
  take_columns(request, *file, measurement);
  check_columns(measurement, request.missing);
  return measurement;
}

}  // namespace strut
