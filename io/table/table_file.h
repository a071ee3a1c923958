// The columns of a file that another program wrote, in any format that strut reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/table/csv.h"

namespace strut {

class TableFile {
 public:
  virtual ~TableFile() = default;

  /// "text separated by semicolons, decimal comma", "HDF5", "MATLAB 5"
  virtual std::string format() const = 0;
  virtual std::vector<std::string> names() const = 0;
  /// Returns the column that `name` stands for, by its name or its header. Throws
  /// missing_column_error, and InputError for a column that cannot be used.
  virtual CsvColumn read(const std::string& name) const = 0;
  virtual bool has(const std::string& name) const;
  /// Text: the line in the file of each row; otherwise empty.
  virtual std::vector<int> lines() const { return {}; }
  /// For the user: what was left out or assumed.
  virtual std::vector<std::string> notes() const { return {}; }
};

/// The formats that a file's first bytes tell apart.
enum class TableFormat { kText, kHdf5, kMatlab5 };

/// Returns the format by the file's content; by its name for .h5 and .hdf5. Throws InputError for a
/// missing file, and for formats that strut does not read, with the way to convert them.
TableFormat find_table_format(const std::filesystem::path& path);

/// A text table as a TableFile.
class TextTableFile : public TableFile {
 public:
  explicit TextTableFile(const std::filesystem::path& path,
                         MissingCells missing = MissingCells::kNan)
      : table_(read_csv(path, missing)) {}

  std::string format() const override { return "text " + table_.format; }
  std::vector<std::string> names() const override;
  CsvColumn read(const std::string& name) const override { return table_.column(name); }
  bool has(const std::string& name) const override { return table_.has(name); }
  std::vector<int> lines() const override { return table_.lines; }
  std::vector<std::string> notes() const override { return table_.notes; }

 private:
  CsvTable table_;
};

}  // namespace strut
