// Numeric tables as comma-separated text.
//
//     time,body_position_z
//     # units: s,m
//     0,0.5373
//
// The first line holds the names, where every tool finds them; the units follow in a comment line,
// which is omitted if no column has one. pandas: `read_csv(f, comment="#")`; NumPy:
// `genfromtxt(f, delimiter=",", names=True)`; MATLAB: `readtable(f, "CommentStyle", "#")`; gnuplot
// needs only the separator.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/folder.h"

namespace strut {

struct CsvColumn {
  std::string name;
  std::string unit;  // may be ""
  std::vector<double> values;
};

struct CsvTable {
  std::filesystem::path path;  // the file, for messages
  std::vector<CsvColumn> columns;
  std::vector<int> lines;  // line in the file of each row

  std::size_t row_count() const { return lines.size(); }
  bool has(const std::string& name) const;
  /// Throws missing_column_error.
  const CsvColumn& column(const std::string& name) const;
};

/// Returns the error for a column `name` that is not among `names`, the columns of `path`; suggests
/// the nearest.
InputError missing_column_error(const std::filesystem::path& path, const std::string& name,
                                const std::vector<std::string>& names);

/// Writes columns of equal length; every number reads back as the same double. The file appears
/// whole or not at all. Throws EnvironmentError.
void write_csv(const std::filesystem::path& path, const std::vector<CsvColumn>& columns);
/// Writes likewise inside a folder that strut makes. Throws as AtomicFile does.
void write_csv(const Folder& folder, const std::string& name,
               const std::vector<CsvColumn>& columns);

/// Treatment of cells that are empty or say nan.
enum class MissingCells {
  kRefused,  // an error, with file and line
  kNan,      // a missing sample
};

/// Reads a file as `write_csv` writes it; also with CR LF line ends, blanks around cells, names in
/// quotes, comments and empty lines anywhere. Throws InputError with file and line for a missing
/// file, a row of the wrong length, a cell that is not a finite number, an empty or repeated name,
/// a line of more than 1 MiB, more than 16384 columns.
CsvTable read_csv(const std::filesystem::path& path, MissingCells missing = MissingCells::kRefused);

}  // namespace strut
