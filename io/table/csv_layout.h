// The dialect of a text table, as its first lines show it: separator, decimal sign, names, units.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/format/text_line.h"

namespace strut {

/// Separates cells at runs of blanks instead of at a character.
inline constexpr char kBlankSeparated = ' ';

/// A line without its end.
struct NumberedLine {
  int number = 0;
  std::string text;
};

struct CsvLayout {
  char separator = ',';
  char decimal = '.';
  std::size_t columns = 0;  // cells of a row
  bool is_vbox = false;     // a .vbo file, whose time is a compact clock
  /// Indices in the given lines: of the line of names and the line of units (-1: none), and of the
  /// first row. Lines before the names are ignored.
  int names = -1, units = -1;
  std::size_t first_row = 0;

  /// "separated by semicolons, decimal comma"
  std::string describe() const;
};

/// Splits a line at its separators, outside of quotes; blanks around cells and quotes around their
/// text are removed.
std::vector<std::string_view> split_cells(std::string_view line, char separator);

/// Finds the layout of the table that begins with `lines`, none of them empty or a comment: the
/// separator and decimal sign with which most lines are rows of numbers, clock times and missing
/// samples of one length. Where fewer than half of the lines from the first row on are, a row need
/// only have one number besides other text. The names are in the line above the first row, or above
/// a line of units up to two lines higher. A line that numbers the columns is not a row; it is the
/// line of names where there is no other. Lines without any such row are a line of names, separated
/// by commas, and what follows.
CsvLayout find_csv_layout(const std::vector<NumberedLine>& lines);

}  // namespace strut
