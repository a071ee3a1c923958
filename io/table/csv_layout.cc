#include "io/table/csv_layout.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "base/names/name_table.h"
#include "base/text/parse_number.h"
#include "io/table/column_name.h"
#include "io/table/csv_cell.h"

namespace strut {
namespace {

constexpr std::string_view kBlanks = " \t";

struct Separator {
  char sign;
  const char* name;
};
/// In order of preference among equals.
constexpr Separator kSeparators[] = {{'\t', "tabs"},
                                     {';', "semicolons"},
                                     {',', "commas"},
                                     {'|', "bars"},
                                     {kBlankSeparated, "blanks"}};

/// End of the cell that begins at the start of `line`: its separator or the line's end.
std::size_t find_cell_end(std::string_view line, char separator) {
  const auto begin = line.find_first_not_of(separator == '\t' ? " " : kBlanks);
  std::size_t from = 0;
  if (begin != std::string_view::npos && line[begin] == '"') {
    const auto close = line.find('"', begin + 1);
    if (close != std::string_view::npos) from = close + 1;
  }
  const auto end = line.find(separator, from);
  return end == std::string_view::npos ? line.size() : end;
}

std::string_view strip_quotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? trim(text.substr(1, text.size() - 2), kBlanks) : text;
}

std::vector<std::string_view> split_at_blanks(std::string_view line) {
  std::vector<std::string_view> cells;
  line = trim(line, kBlanks);
  while (!line.empty()) {
    const bool quoted = line.front() == '"' && line.find('"', 1) != std::string_view::npos;
    const auto end = quoted ? line.find('"', 1) + 1 : line.find_first_of(kBlanks);
    cells.push_back(strip_quotes(line.substr(0, end)));
    line = end == std::string_view::npos ? "" : trim(line.substr(end), kBlanks);
  }
  return cells;
}

/// A line is a row if most (kMost) or at least one (kAny) of its cells are numbers or clock times;
/// missing cells do not count.
enum class RowRule { kMost, kAny };

bool is_row(const std::vector<std::string_view>& cells, char decimal, RowRule rule) {
  std::size_t values = 0, missing = 0;
  for (const std::string_view cell : cells) {
    if (is_missing_cell(cell)) {
      ++missing;
    } else if (parse_cell_number(cell, decimal) || parse_cell_clock(cell)) {
      ++values;
    }
  }
  return values > 0 && (rule == RowRule::kAny || 2 * values > cells.size() - missing);
}

/// The table as one dialect reads it.
struct Reading {
  CsvLayout layout;
  std::size_t rows = 0, values = 0, cells = 0;
  bool is_found = false;

  /// Rows of numbers alone before others, then tables with several columns, then the most rows.
  std::tuple<double, bool, std::size_t> rank() const {
    const double fraction =
        cells == 0 ? 0.0 : static_cast<double>(values) / static_cast<double>(cells);
    return {fraction, layout.columns > 1, rows};
  }
};

/// Number of cells that most rows of numbers have; 0 where there are none.
std::size_t find_width(const std::vector<std::vector<std::string_view>>& lines, char decimal,
                       RowRule rule) {
  std::map<std::size_t, std::size_t> counts;
  for (const auto& cells : lines) {
    if (is_row(cells, decimal, rule)) ++counts[cells.size()];
  }
  // The wider of equals: a row may be cut off, but none is longer than the others.
  const auto best =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second <= b.second; });
  return best == counts.end() ? 0 : best->first;
}

Reading read_as(const std::vector<NumberedLine>& lines, char separator, char decimal,
                RowRule rule) {
  std::vector<std::vector<std::string_view>> split;
  split.reserve(lines.size());
  for (const NumberedLine& line : lines) split.push_back(split_cells(line.text, separator));
  Reading reading;
  CsvLayout& layout = reading.layout;
  layout.separator = separator;
  layout.decimal = decimal;
  layout.columns = find_width(split, decimal, rule);
  if (layout.columns == 0) return reading;
  const auto fits = [&](const auto& cells) {
    return cells.size() == layout.columns && is_row(cells, decimal, rule);
  };
  layout.first_row =
      static_cast<std::size_t>(std::find_if(split.begin(), split.end(), fits) - split.begin());
  reading.is_found = true;
  for (std::size_t i = layout.first_row; i < split.size(); ++i) {
    if (!fits(split[i])) continue;
    ++reading.rows;
    for (const std::string_view cell : split[i]) {
      if (is_missing_cell(cell)) continue;
      ++reading.cells;
      reading.values += parse_cell_number(cell, decimal) || parse_cell_clock(cell) ? 1 : 0;
    }
  }
  return reading;
}

/// Whether the cells of the line above the rows are units.
bool are_units(const std::vector<std::string_view>& cells) {
  const bool all = std::all_of(cells.begin(), cells.end(), is_unit_cell);
  return all && std::any_of(cells.begin(), cells.end(),
                            [](std::string_view cell) { return !parse_unit_cell(cell).empty(); });
}

/// Whether the cells number the columns: consecutive integers, where those of the row below have a
/// decimal sign.
bool are_column_numbers(const std::vector<std::string_view>& cells,
                        const std::vector<std::string_view>& below, char decimal) {
  constexpr std::size_t kMinColumns = 3;
  std::optional<int> last;
  std::size_t numbers = 0, decimals = 0;
  for (std::size_t c = 0; c < cells.size() && c < below.size(); ++c) {
    if (cells[c].empty()) continue;
    const auto number = parse_number<int>(cells[c]);
    if (!number || (last && *number != *last + 1)) return false;
    last = number;
    ++numbers;
    decimals += below[c].find(decimal) != std::string_view::npos ? 1 : 0;
  }
  return numbers >= kMinColumns && 2 * decimals > numbers;
}

/// Whether a line is the begin of a section, "[data]".
bool is_section(const std::vector<std::string_view>& cells) {
  return cells.size() == 1 && cells.front().starts_with('[') && cells.front().ends_with(']');
}

void find_names(const std::vector<NumberedLine>& lines, CsvLayout& layout) {
  const auto split = [&](std::size_t line) {
    return split_cells(lines[line].text, layout.separator);
  };
  const auto has_number = [&](std::size_t line) {
    const auto cells = split(line);
    return std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
      return parse_cell_number(cell, layout.decimal).has_value();
    });
  };
  const auto numbers_columns = [&](std::size_t line) {
    return line + 1 < lines.size() &&
           are_column_numbers(split(line), split(line + 1), layout.decimal);
  };
  std::size_t top = layout.first_row;  // the lines from here on are no names
  if (numbers_columns(layout.first_row)) {
    ++layout.first_row;
  } else if (top > 0 && numbers_columns(top - 1)) {
    --top;
  } else {
    // A line with a number is not one of names, but a damaged row.
    while (top > 0 && has_number(top - 1)) --top;
    layout.first_row = top;
  }
  while (top > 0 && is_section(split(top - 1))) --top;
  const auto is_wide = [&](std::size_t line) { return split(line).size() >= layout.columns; };
  if (top == 0) {
    if (layout.first_row > 0) layout.names = static_cast<int>(layout.first_row) - 1;
    return;
  }
  layout.names = static_cast<int>(top) - 1;
  constexpr std::size_t kLinesBelowNames = 3;
  for (std::size_t below = 1; below <= kLinesBelowNames && below < top; ++below) {
    const std::size_t line = top - below;
    if (!is_wide(line) || has_number(line)) return;
    if (!are_units(split(line)) || !is_wide(line - 1)) continue;
    layout.units = static_cast<int>(line);
    layout.names = layout.units - 1;
    return;
  }
}

bool is_vbox_file(const std::vector<NumberedLine>& lines) {
  return std::any_of(lines.begin(), lines.end(), [](const NumberedLine& line) {
    return trim(line.text, kBlanks) == "[column names]";
  });
}

}  // namespace

std::string CsvLayout::describe() const {
  std::string text = "separated by ";
  for (const Separator& s : kSeparators) text += s.sign == separator ? s.name : "";
  return text + (decimal == ',' ? ", decimal comma" : "");
}

std::vector<std::string_view> split_cells(std::string_view line, char separator) {
  if (separator == kBlankSeparated) return split_at_blanks(line);
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t end = find_cell_end(line, separator);
    cells.push_back(strip_quotes(trim(line.substr(0, end), kBlanks)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

CsvLayout find_csv_layout(const std::vector<NumberedLine>& lines) {
  Reading best;
  for (const RowRule rule : {RowRule::kMost, RowRule::kAny}) {
    if (best.is_found && 2 * best.rows >= lines.size() - best.layout.first_row) break;
    for (const char decimal : {'.', ','}) {
      for (const Separator& separator : kSeparators) {
        const Reading reading = read_as(lines, separator.sign, decimal, rule);
        // Where rows are few, more of them count more than their texts.
        const bool is_better = rule == RowRule::kAny && best.is_found
                                   ? reading.rows > 2 * best.rows
                                   : reading.rank() > best.rank();
        if (reading.is_found && (!best.is_found || is_better)) best = reading;
      }
    }
  }
  if (best.is_found) {
    best.layout.is_vbox = is_vbox_file(lines);
    find_names(lines, best.layout);
    return best.layout;
  }
  CsvLayout layout;
  layout.names = lines.empty() ? -1 : 0;
  layout.first_row = lines.empty() ? 0 : 1;
  if (!lines.empty()) layout.columns = split_cells(lines.front().text, layout.separator).size();
  return layout;
}

}  // namespace strut
