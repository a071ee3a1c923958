#include "io/store/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "io/format/hdf5.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// The columns of an HDF5 file in any of its layouts.
class Hdf5Columns {
 public:
  Hdf5Columns(const fs::path& path, MeasuredPart part) : path_(path), file_(path) {
    const bool is_snapshot = part == MeasuredPart::kSnapshot;
    const std::string group = is_snapshot ? kSnapshotName : kHistoryGroup;
    const std::string other = is_snapshot ? kHistoryGroup : kSnapshotName;
    if (file_.has(group)) {
      open(group);
    } else if (file_.has(other)) {
      throw error(group, fmt::format("no such group; the file has only {}", other));
    } else {
      names_ = file_.list("/");
    }
  }

  const std::vector<std::string>& names() const { return names_; }

  CsvColumn read(const std::string& name) const {
    if (is_table_) return cut_column(name);
    const std::string dataset = fmt::format("{}/{}", group_, name);
    Hdf5Dataset data = file_.read(dataset);
    const bool has_rows = data.shape.size() == 2 && data.shape.front() > 1;
    if (has_rows && group_ == kHistoryGroup) {
      throw error(dataset,
                  fmt::format("histories of {} cases; must be one: put it into a file of its own",
                              data.shape.front()));
    }
    if (has_rows && data.shape.back() > 1) throw error(dataset, "must have one dimension");
    return {name, data.label.unit, std::move(data.values)};
  }

 private:
  void open(const std::string& group) {
    // Only datasets have a unit.
    is_table_ = file_.has_attribute(group, "unit");
    if (is_table_) {
      table_ = file_.read(group);
      names_ = table_.label.names;
    } else {
      names_ = file_.list(group);
      group_ = group;
    }
    const bool fits = !is_table_ || (table_.shape.size() == 2 && table_.shape[1] == names_.size());
    if (!fits) throw error(group, "must have a name for each column");
  }

  InputError error(const std::string& object, const std::string& what) const {
    return InputError(fmt::format("{}: {}: {}", path_.string(), object, what));
  }

  CsvColumn cut_column(const std::string& name) const {
    const auto at =
        static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
    const auto& units = table_.label.units;
    CsvColumn column{name, at < units.size() ? units[at] : table_.label.unit, {}};
    const std::size_t rows = table_.shape[0];
    column.values.reserve(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      column.values.push_back(table_.values[row * names_.size() + at]);
    }
    return column;
  }

  fs::path path_;
  Hdf5Reader file_;
  std::vector<std::string> names_;
  std::string group_;  // group of the columns, unless they are a table
  Hdf5Dataset table_;
  bool is_table_ = false;
};

/// Reads the columns of `request` from a file whose columns are `names`.
template <class Read>
void take_columns(const MeasurementRequest& request, const std::vector<std::string>& names,
                  const Read& read, Measurement& measurement) {
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& name : request.required) {
    if (!has(name)) throw missing_column_error(measurement.path, name, names);
    measurement.columns.push_back(read(name));
  }
  for (const std::string& name : request.optional) {
    if (has(name)) measurement.columns.push_back(read(name));
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

std::string Measurement::locate(std::size_t row) const {
  if (row < lines.size()) return fmt::format("{}:{}", path.string(), lines[row]);
  return fmt::format("{}: row {}", path.string(), row);
}

Measurement read_measurement(const fs::path& path, const MeasurementRequest& request) {
  Measurement measurement;
  measurement.path = path;
  const std::string extension = path.extension().string();
  if (extension == ".h5" || extension == ".hdf5") {
    const Hdf5Columns file(path, request.part);
    take_columns(
        request, file.names(), [&](const auto& name) { return file.read(name); }, measurement);
  } else {
    const CsvTable table = read_csv(path, request.missing);
    measurement.lines = table.lines;
    std::vector<std::string> names;
    names.reserve(table.columns.size());
    for (const CsvColumn& column : table.columns) names.push_back(column.name);
    take_columns(
        request, names, [&](const auto& name) { return table.column(name); }, measurement);
  }
  check_columns(measurement, request.missing);
  return measurement;
}

void require_units(const Measurement& measurement, const std::vector<ColumnInfo>& expected) {
  for (const ColumnInfo& column : expected) {
    const std::string& unit = measurement.find(column.name)->unit;
    if (unit.empty() || unit == column.unit) continue;
    throw InputError(fmt::format("{}: {} is in {}; must be in {}", measurement.path.string(),
                                 column.name, unit, column.unit));
  }
}

}  // namespace strut
