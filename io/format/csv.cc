#include "io/format/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <string_view>

#include "base/error/check.h"
#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "base/text/shorten.h"
#include "io/file/atomic_file.h"
#include "io/file/file_sync.h"
#include "io/format/text_line.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUnitsMark = "# units:";
constexpr std::string_view kBlanks = " \t\r";
/// Bounds on what is read, far above any real table: the file may be something else, given by
/// mistake.
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxColumns = 16384;
/// Bytes of text per write.
constexpr std::size_t kWriteBytes = std::size_t{1} << 20U;

std::string_view strip_quotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trim(line.substr(0, comma), kBlanks));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::vector<CsvColumn> parse_names(const TextLine& line) {
  const auto cells = split_cells(line.text);
  if (cells.size() > kMaxColumns) {
    throw line_error(line,
                     fmt::format("{} columns; at most {} are allowed", cells.size(), kMaxColumns));
  }
  std::vector<CsvColumn> columns;
  std::set<std::string> seen;
  for (const std::string_view cell : cells) {
    const std::string name(strip_quotes(cell));
    if (name.empty()) throw line_error(line, "a column has no name; every column needs one");
    if (!seen.insert(name).second) {
      throw line_error(line,
                       fmt::format("column '{}' is given twice; names must differ", shorten(name)));
    }
    if (parse_number<double>(name)) {
      throw line_error(
          line, fmt::format("column name expected, number {} found; the first line must hold names",
                            shorten(name)));
    }
    columns.push_back({name, "", {}});
  }
  return columns;
}

void set_units(const TextLine& line, std::vector<CsvColumn>& columns) {
  const auto units = split_cells(line.text.substr(kUnitsMark.size()));
  if (columns.empty() || units.size() != columns.size()) {
    throw line_error(line, "the line of units must follow the names and have one unit per column");
  }
  for (std::size_t c = 0; c < units.size(); ++c) columns[c].unit = std::string(units[c]);
}

/// Returns whether a cell is empty or "nan" in any case.
bool is_missing(std::string_view cell) {
  constexpr std::string_view kNan = "nan";
  return cell.empty() || (cell.size() == kNan.size() &&
                          std::equal(cell.begin(), cell.end(), kNan.begin(), [](char a, char b) {
                            return (a | 0x20) == b;  // lower case
                          }));
}

double parse_cell(const TextLine& line, std::string_view cell, const std::string& column,
                  MissingCells missing) {
  if (missing == MissingCells::kNan && is_missing(cell)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
  const auto value = parse_number<double>(digits);
  if (value && std::isfinite(*value)) return *value;
  throw line_error(
      line, fmt::format("{} = '{}': must be a finite number", shorten(column), shorten(cell)));
}

void add_row(const TextLine& line, MissingCells missing, CsvTable& table) {
  const auto cells = split_cells(line.text);
  if (cells.size() != table.columns.size()) {
    throw line_error(line, fmt::format("{} cells; must be {}, one per column", cells.size(),
                                       table.columns.size()));
  }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    table.columns[c].values.push_back(parse_cell(line, cells[c], table.columns[c].name, missing));
  }
  table.lines.push_back(line.number);
}

void add_line(TextLine line, MissingCells missing, CsvTable& table) {
  if (line.number == 1 && line.text.starts_with(kByteOrderMark)) {
    line.text.remove_prefix(kByteOrderMark.size());
  }
  line.text = trim(line.text, kBlanks);
  if (line.text.empty()) return;
  if (line.text.starts_with(kUnitsMark)) {
    set_units(line, table.columns);
  } else if (line.text.front() == '#') {
    return;
  } else if (table.columns.empty()) {
    table.columns = parse_names(line);
  } else {
    add_row(line, missing, table);
  }
}

CsvTable parse_csv(std::istream& stream, const fs::path& path, MissingCells missing) {
  CsvTable table;
  table.path = path;
  std::vector<char> buffer(kMaxLineBytes + 1);
  TextLine line{path};
  while (stream.getline(buffer.data(), std::ssize(buffer)) || stream.gcount() > 0) {
    ++line.number;
    if (stream.fail()) {
      throw line_error(line, fmt::format("more than {} bytes in one line; not a table of numbers",
                                         kMaxLineBytes));
    }
    const std::streamsize length = stream.gcount() - (stream.eof() ? 0 : 1);  // the line end
    line.text = {buffer.data(), static_cast<std::size_t>(length)};
    add_line(line, missing, table);
  }
  if (table.columns.empty()) {
    throw line_error(line, "no line of column names; the first line must hold them");
  }
  return table;
}

void append_number(std::string& line, double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  line.append(buffer.data(), result.ptr);
}

void check_columns(const std::vector<CsvColumn>& columns) {
  for (const CsvColumn& column : columns) {
    STRUT_CHECK(column.values.size() == columns.front().values.size(),
                fmt::format("write_csv: the length of column '{}' differs", column.name));
  }
}

std::string make_heading(const std::vector<CsvColumn>& columns) {
  std::string names, units;
  bool any_unit = false;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    names += (c == 0 ? "" : ",") + columns[c].name;
    units += (c == 0 ? " " : ",") + columns[c].unit;
    any_unit = any_unit || !columns[c].unit.empty();
  }
  names += '\n';
  if (any_unit) names.append(kUnitsMark).append(units) += '\n';
  return names;
}

void write_columns(AtomicFile& file, const std::vector<CsvColumn>& columns) {
  check_columns(columns);
  const auto write = [&](const std::string& text) { file.write(std::as_bytes(std::span(text))); };
  const std::size_t rows = columns.empty() ? 0 : columns.front().values.size();
  std::string text = make_heading(columns);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) text += ',';
      append_number(text, columns[c].values[r]);
    }
    text += '\n';
    if (text.size() < kWriteBytes) continue;
    write(text);
    text.clear();
  }
  write(text);
  file.commit();
}

}  // namespace

bool CsvTable::has(const std::string& name) const {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const CsvColumn& column) { return column.name == name; });
}

const CsvColumn& CsvTable::column(const std::string& name) const {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) {
    if (column.name == name) return column;
    names.push_back(column.name);
  }
  throw missing_column_error(path, name, names);
}

InputError missing_column_error(const fs::path& path, const std::string& name,
                                const std::vector<std::string>& names) {
  return InputError(fmt::format("{}: no column '{}' among {}{}", path.string(), shorten(name),
                                join_names(names), suggest_name(name, names)));
}

void write_csv(const fs::path& path, const std::vector<CsvColumn>& columns) {
  AtomicFile file(path);
  write_columns(file, columns);
}

void write_csv(const Folder& folder, const std::string& name,
               const std::vector<CsvColumn>& columns) {
  AtomicFile file(folder, name);
  write_columns(file, columns);
}

CsvTable read_csv(const fs::path& path, MissingCells missing) {
  open_regular_file(path);  // a stream would wait for the other end of a pipe
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw EnvironmentError(fmt::format("{}: {}", path.string(), kNotRead));
  CsvTable table = parse_csv(stream, path, missing);
  if (stream.bad())
    throw EnvironmentError(fmt::format("{}: {} to its end", path.string(), kNotRead));
  return table;
}

}  // namespace strut
