#include "io/table/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "base/error/check.h"
#include "base/text/nearest_name.h"
#include "base/text/shorten.h"
#include "io/file/atomic_file.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

/// Bytes of text per write.
constexpr std::size_t kWriteBytes = std::size_t{1} << 20U;

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
  if (any_unit) names.append(kCsvUnitsMark).append(units) += '\n';
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
                     [&](const CsvColumn& column) { return column.is_named(name); });
}

const CsvColumn& CsvTable::column(const std::string& name) const {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) {
    if (column.is_named(name) && !column.fault.empty()) throw InputError(column.fault);
    if (column.is_named(name)) return column;
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

}  // namespace strut
