// Numeric tables as comma-separated text.
//
//     time,body_position_z
//     # units: s,m
//     0,0.5373
//
// The names stand on the first line, so that every tool finds them; the units follow in a comment
// line, which is left out where no column has one. pandas: `read_csv(f, comment="#")`; NumPy:
// `genfromtxt(f, delimiter=",", names=True)`; MATLAB: `readtable(f, "CommentStyle", "#")`; gnuplot
// needs nothing but its separator.
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
  std::filesystem::path path;  // where it was read from, for messages
  std::vector<CsvColumn> columns;
  std::vector<int> lines;  // line in the file of each row

  std::size_t row_count() const { return lines.size(); }
  bool has(const std::string& name) const;
  /// Throws InputError that lists the columns and suggests the nearest name.
  const CsvColumn& column(const std::string& name) const;
};

/// Writes columns of equal length; every number reads back as the same double. The file appears
/// whole or not at all. Throws EnvironmentError.
void write_csv(const std::filesystem::path& path, const std::vector<CsvColumn>& columns);
/// The same inside a folder that strut makes. Throws as AtomicFile does.
void write_csv(const Folder& folder, const std::string& name,
               const std::vector<CsvColumn>& columns);

/// What an empty cell, or one that says nan, is.
enum class MissingCells {
  kRefused,  // an error, with file and line
  kNan,      // a sample that is missing
};

/// Reads a file as `write_csv` writes it; also with CR LF line ends, blanks around cells, names in
/// quotes, comment and empty lines anywhere. Throws InputError with file and line for a missing
/// file, a row of the wrong length, a cell that is not a finite number, an empty or repeated name,
/// a line of more than 1 MiB, more than 16384 columns.
CsvTable read_csv(const std::filesystem::path& path, MissingCells missing = MissingCells::kRefused);

}  // namespace strut
