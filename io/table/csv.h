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
#include <string_view>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/folder.h"

namespace strut {

struct CsvColumn {
  std::string name;
  std::string unit;  // may be ""
  std::vector<double> values;
  std::string header{};  // the name with its unit as the file has them; "": as `name`
  /// Why the column cannot be used, with file and line: a cell that is not a finite number; "":
  /// it can.
  std::string fault{};

  bool is_named(const std::string& text) const { return text == name || text == header; }
};

struct CsvTable {
  std::filesystem::path path;  // the file, for messages
  std::string format;          // "separated by semicolons, decimal comma"
  std::vector<CsvColumn> columns;
  std::vector<int> lines;          // line in the file of each row
  std::vector<std::string> notes;  // for the user: what was left out or assumed

  std::size_t row_count() const { return lines.size(); }
  bool has(const std::string& name) const;
  /// Throws missing_column_error, or InputError with the column's fault.
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

/// Begin of the comment that holds the units of written tables.
inline constexpr std::string_view kCsvUnitsMark = "# units:";

/// Treatment of missing samples: cells that are empty, or say nan, n/a, null or "-".
enum class MissingCells {
  kRefused,  // a fault of the column, with file and line
  kNan,      // a missing sample
};

/// Reads a table of numbers, as `write_csv` or another program writes it:
///  - UTF-8, Latin-1, or UTF-16 with a byte order mark; any line ends;
///  - separated by tabs, semicolons, commas, bars or blanks, with decimal point or comma
///    (csv_layout.h);
///  - lines of other text above the names, and a line of units below them; units beside the names
///    ("AccZ [g]", column_name.h) or in a comment; without names: column_1, column_2, ...; the
///    first column is `time` if it alone has no name;
///  - clock times (csv_cell.h), and times since 1970 in ms, us or ns, as seconds since the first
///  row;
///  - comments (#, %, //), empty lines and trailing separators anywhere.
/// Columns of one name get a number: "acc (1)", "acc (2)".
/// Throws InputError with file and line for a missing file, a row of the wrong length, a line of
/// more than 1 MiB, more than 16384 columns, binary data.
CsvTable read_csv(const std::filesystem::path& path, MissingCells missing = MissingCells::kRefused);

}  // namespace strut
