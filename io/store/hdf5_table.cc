#include "io/store/hdf5_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/format/hdf5.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

InputError make_error(const fs::path& path, const std::string& object, const std::string& what) {
  return InputError(fmt::format("{}: {}: {}", path.string(), object, what));
}

/// A dataset with a row per case or time and named columns.
class NamedTable : public TableFile {
 public:
  NamedTable(const fs::path& path, const Hdf5Reader& file, const std::string& name)
      : path_(path), table_(file.read(name)) {
    if (table_.shape.size() == 2 && table_.shape[1] == table_.label.names.size()) return;
    throw make_error(path, name, "must have a name for each column");
  }

  std::string format() const override { return "HDF5"; }
  std::vector<std::string> names() const override { return table_.label.names; }

  CsvColumn read(const std::string& name) const override {
    const std::vector<std::string>& names = table_.label.names;
    const auto at =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (at == names.size()) throw missing_column_error(path_, name, names);
    const auto& units = table_.label.units;
    CsvColumn column{name, at < units.size() ? units[at] : table_.label.unit, {}};
    const std::size_t rows = table_.shape[0];
    column.values.reserve(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      column.values.push_back(table_.values[row * names.size() + at]);
    }
    return column;
  }

 private:
  fs::path path_;
  Hdf5Dataset table_;
};

/// A dataset per column.
class DatasetColumns : public TableFile {
 public:
  DatasetColumns(const fs::path& path, Hdf5Reader file, std::string group)
      : path_(path), file_(std::move(file)), group_(std::move(group)), names_(file_.list(group_)) {}

  std::string format() const override { return "HDF5"; }
  std::vector<std::string> names() const override { return names_; }

  CsvColumn read(const std::string& name) const override {
    if (!has(name)) throw missing_column_error(path_, name, names_);
    const std::string dataset = fmt::format("{}/{}", group_, name);
    Hdf5Dataset data = file_.read(dataset);
    const bool has_rows = data.shape.size() == 2 && data.shape.front() > 1;
    if (has_rows && group_ == kHistoryGroup) {
      throw make_error(path_, dataset,
                       fmt::format("histories of {} cases; must be one: put it into a file of its "
                                   "own",
                                   data.shape.front()));
    }
    if (has_rows && data.shape.back() > 1) {
      throw make_error(path_, dataset, "must have one dimension");
    }
    return {name, data.label.unit, std::move(data.values)};
  }

 private:
  fs::path path_;
  Hdf5Reader file_;
  std::string group_;
  std::vector<std::string> names_;
};

/// The numeric datasets of a file of another program.
class ForeignDatasets : public TableFile {
 public:
  ForeignDatasets(const fs::path& path, Hdf5Reader file) : path_(path), file_(std::move(file)) {
    add_group("", 0);
    if (!columns_.empty()) return;
    throw make_error(path, "/",
                     "no dataset of numbers of one or two dimensions; the fields of records "
                     "(compound types) must be datasets of their own");
  }

  std::string format() const override { return is_matlab_ ? "MATLAB 7.3 (HDF5)" : "HDF5"; }

  std::vector<std::string> names() const override {
    std::vector<std::string> names;
    names.reserve(columns_.size());
    for (const Place& place : columns_) names.push_back(place.name);
    return names;
  }

  std::vector<std::string> notes() const override { return notes_; }

  CsvColumn read(const std::string& name) const override {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const Place& place) { return place.name == name; });
    if (found == columns_.end()) throw missing_column_error(path_, name, names());
    // The columns of a matrix are read one after another.
    if (found->dataset != last_dataset_) last_ = file_.read("/" + found->dataset);
    last_dataset_ = found->dataset;
    const Hdf5Dataset& data = last_;
    CsvColumn column{name, data.label.unit, {}};
    if (column.unit.empty() && data.label.units.size() == 1) column.unit = data.label.units[0];
    for (std::size_t i = 0; i < found->count; ++i) {
      column.values.push_back(data.values[found->first + i * found->stride]);
    }
    return column;
  }

 private:
  /// A column: `count` values of a dataset from `first`, `stride` apart.
  struct Place {
    std::string name, dataset;
    std::size_t first = 0, stride = 1, count = 0;
  };

  void add_group(const std::string& group, int depth) {
    constexpr int kMaxDepth = 4;
    constexpr std::size_t kMaxColumns = 16384;
    for (const std::string& name : file_.list("/" + group)) {
      if (name.starts_with('#')) continue;  // MATLAB's own
      const std::string object = group.empty() ? name : group + "/" + name;
      Hdf5Kind kind = Hdf5Kind::kOther;
      try {
        kind = file_.find_kind("/" + object);
        if (kind == Hdf5Kind::kNumbers) add_dataset(object);
      } catch (const InputError& error) {  // a link into another file, a view of one
        notes_.push_back(fmt::format("{} (left out)", error.what()));
      }
      if (kind == Hdf5Kind::kGroup && depth < kMaxDepth) add_group(object, depth + 1);
      if (columns_.size() > kMaxColumns) {
        throw make_error(path_, "/", fmt::format("more than {} columns", kMaxColumns));
      }
    }
  }

  void add_dataset(const std::string& dataset) {
    constexpr char kClass[] = "MATLAB_class";
    constexpr std::size_t kMaxTableColumns = 1024;
    const bool is_matlab = file_.has_attribute("/" + dataset, kClass);
    is_matlab_ = is_matlab_ || is_matlab;
    if (is_matlab && file_.read_attribute("/" + dataset, kClass) == "char") return;
    const std::vector<std::size_t> shape = file_.read_shape("/" + dataset);
    const std::size_t rows = shape.front(), width = shape.size() == 2 ? shape.back() : 1;
    if (rows == 1 || width == 1) {
      columns_.push_back({dataset, dataset, 0, 1, rows * width});
      return;
    }
    // MATLAB stores matrices column by column.
    const std::size_t columns = is_matlab ? rows : width, count = is_matlab ? width : rows;
    for (std::size_t c = 0; c < columns && columns <= kMaxTableColumns; ++c) {
      columns_.push_back({fmt::format("{}:{}", dataset, c + 1), dataset, is_matlab ? c * width : c,
                          is_matlab ? 1 : width, count});
    }
  }

  fs::path path_;
  Hdf5Reader file_;
  std::vector<Place> columns_;
  std::vector<std::string> notes_;
  bool is_matlab_ = false;
  mutable Hdf5Dataset last_;
  mutable std::string last_dataset_;
};

}  // namespace

std::unique_ptr<TableFile> open_hdf5_table(const fs::path& path, MeasuredPart part) {
  Hdf5Reader file(path);
  const bool is_snapshot = part == MeasuredPart::kSnapshot;
  const std::string group = is_snapshot ? kSnapshotName : kHistoryGroup;
  const std::string other = is_snapshot ? kHistoryGroup : kSnapshotName;
  if (!file.has(group) && !file.has(other)) {
    return std::make_unique<ForeignDatasets>(path, std::move(file));
  }
  if (!file.has(group)) {
    throw make_error(path, group, fmt::format("no such group; the file has only {}", other));
  }
  // Only datasets have a unit.
  if (file.has_attribute(group, "unit")) return std::make_unique<NamedTable>(path, file, group);
  return std::make_unique<DatasetColumns>(path, std::move(file), group);
}

}  // namespace strut
