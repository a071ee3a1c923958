#include "io/table/csv_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/table/column_name.h"
#include "io/table/csv_cell.h"
#include "io/table/text_encoding.h"

namespace strut {
namespace {

constexpr char kTimeName[] = "time";

/// The cells of a line, without the empty ones that separators at its end make.
std::vector<std::string> split_line(std::string_view line, const CsvLayout& layout) {
  std::vector<std::string> cells;
  for (const std::string_view cell : split_cells(line, layout.separator)) {
    cells.push_back(convert_latin1(cell));
  }
  while (cells.size() > layout.columns && cells.back().empty()) cells.pop_back();
  return cells;
}

std::vector<std::string> find_headers(const std::vector<NumberedLine>& lines,
                                      const CsvLayout& layout, const std::string& comment) {
  if (layout.names >= 0) {
    auto names = split_line(lines[static_cast<std::size_t>(layout.names)].text, layout);
    // LabVIEW names a column that only the first row of a file may have.
    if (names.size() == layout.columns + 1 && names.back() == "Comment") names.pop_back();
    return names;
  }
  std::vector<std::string> names = split_line(trim(comment, "#%/ \t"), layout);
  const bool fits = names.size() == layout.columns &&
                    std::none_of(names.begin(), names.end(), [&](const std::string& name) {
                      return name.empty() || parse_cell_number(name, layout.decimal);
                    });
  if (!fits) names.assign(layout.columns, "");
  return names;
}

void tell_apart(std::vector<CsvColumn>& columns) {
  std::map<std::string, int> names, headers, seen;
  for (const CsvColumn& column : columns) {
    ++names[column.name];
    ++headers[column.header];
  }
  for (CsvColumn& column : columns) {
    if (names[column.name] == 1) continue;
    if (headers[column.header] == 1) {
      column.name = column.header;
      continue;
    }
    column.name = fmt::format("{} ({})", column.header, ++seen[column.header]);
    column.header = column.name;
  }
}

}  // namespace

std::vector<CsvColumn> make_csv_columns(const std::vector<NumberedLine>& lines,
                                        const CsvLayout& layout, const std::string& comment) {
  const std::vector<std::string> headers = find_headers(lines, layout, comment);
  std::vector<std::string> units;
  if (layout.units >= 0) {
    units = split_line(lines[static_cast<std::size_t>(layout.units)].text, layout);
  }
  std::vector<CsvColumn> columns;
  for (std::size_t c = 0; c < headers.size(); ++c) {
    ColumnName name = split_unit(headers[c]);
    if (c < units.size() && !parse_unit_cell(units[c]).empty()) {
      name = {headers[c], parse_unit_cell(units[c])};
    }
    if (name.name.empty()) name.name = fmt::format("column_{}", c + 1);
    columns.push_back({name.name, name.unit, {}, headers[c]});
  }
  const auto is_nameless = [](const CsvColumn& column) { return column.header.empty(); };
  const bool is_first_alone =
      columns.size() > 1 && is_nameless(columns.front()) &&
      std::none_of(columns.begin() + 1, columns.end(), [&](const CsvColumn& column) {
        return is_nameless(column) || column.name == kTimeName;
      });
  if (is_first_alone) columns.front().name = kTimeName;
  tell_apart(columns);
  return columns;
}

}  // namespace strut
