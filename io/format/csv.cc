#include "io/format/csv.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cerrno>
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

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUnitsMark = "# units:";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
/// Bounds of what is read: no table has more, and something else given by mistake may.
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxColumns = 16384;
/// Bytes of text that are written at once.
constexpr std::size_t kWriteBytes = std::size_t{1} << 20U;

std::string_view trim(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::string_view strip_quotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

void append_number(std::string& line, double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  line.append(buffer.data(), result.ptr);
}

void check_columns(const std::vector<CsvColumn>& columns) {
  for (const CsvColumn& column : columns) {
    STRUT_CHECK(column.values.size() == columns.front().values.size(),
                "write_csv: column '" + column.name + "' has another length");
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

class CsvReader {
 public:
  CsvReader(const fs::path& path, MissingCells missing) : missing_(missing) { table_.path = path; }

  CsvTable read(std::istream& stream) {
    std::vector<char> line(kMaxLineBytes + 1);
    while (stream.getline(line.data(), std::ssize(line)) || stream.gcount() > 0) {
      ++line_;
      if (stream.fail()) {
        throw error("more than " + std::to_string(kMaxLineBytes) + " bytes in one line");
      }
      const std::streamsize length = stream.gcount() - (stream.eof() ? 0 : 1);  // of its end
      take_line({line.data(), static_cast<std::size_t>(length)});
    }
    if (table_.columns.empty()) throw error("no line of column names");
    return std::move(table_);
  }

 private:
  InputError error(const std::string& what) const {
    return InputError(table_.path.string() + ":" + std::to_string(line_) + ": " + what);
  }

  void take_line(std::string_view line) {
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line = trim(line);
    if (line.empty()) return;
    if (line.starts_with(kUnitsMark)) return take_units(line.substr(kUnitsMark.size()));
    if (line.front() == '#') return;
    table_.columns.empty() ? take_names(line) : take_row(line);
  }

  void take_names(std::string_view line) {
    const auto cells = split_cells(line);
    if (cells.size() > kMaxColumns) {
      throw error(std::to_string(cells.size()) + " columns; at most " +
                  std::to_string(kMaxColumns) + " are allowed");
    }
    std::set<std::string> seen;
    for (const std::string_view cell : cells) {
      const std::string name(strip_quotes(cell));
      if (name.empty()) throw error("a column has no name");
      if (!seen.insert(name).second) {
        throw error("column '" + shorten(name) + "' stands there twice");
      }
      if (parse_number<double>(name)) {
        throw error("column name expected, number " + shorten(name) + " found");
      }
      table_.columns.push_back({name, "", {}});
    }
  }

  void take_units(std::string_view line) {
    const auto units = split_cells(line);
    if (table_.columns.empty() || units.size() != table_.columns.size()) {
      throw error("the line of units must follow the names and have one unit a column");
    }
    for (std::size_t c = 0; c < units.size(); ++c) table_.columns[c].unit = std::string(units[c]);
  }

  void take_row(std::string_view line) {
    const auto cells = split_cells(line);
    if (cells.size() != table_.columns.size()) {
      throw error(std::to_string(cells.size()) + " cells, but " +
                  std::to_string(table_.columns.size()) + " columns");
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      table_.columns[c].values.push_back(parse_cell(cells[c], table_.columns[c].name));
    }
    table_.lines.push_back(line_);
  }

  /// Empty, or "nan" in any case.
  static bool is_missing(std::string_view cell) {
    constexpr std::string_view kNan = "nan";
    return cell.empty() || (cell.size() == kNan.size() &&
                            std::equal(cell.begin(), cell.end(), kNan.begin(), [](char a, char b) {
                              return (a | 0x20) == b;  // lower case
                            }));
  }

  double parse_cell(std::string_view cell, const std::string& column) const {
    if (missing_ == MissingCells::kNan && is_missing(cell)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
    const auto value = parse_number<double>(digits);
    if (value && std::isfinite(*value)) return *value;
    throw error(shorten(column) + " = '" + shorten(cell) + "': must be a finite number");
  }

  MissingCells missing_;
  CsvTable table_;
  int line_ = 0;
};

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
  throw InputError(path.string() + ": no column '" + shorten(name) + "' among " +
                   join_names(names) + suggest_name(name, names));
}

namespace {

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
  open_regular_file(path);  // a stream would wait for a pipe's other end
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw EnvironmentError(path.string() + ": cannot be read");
  CsvTable table = CsvReader(path, missing).read(stream);
  if (stream.bad()) throw EnvironmentError(path.string() + ": cannot be read to its end");
  return table;
}

}  // namespace strut
