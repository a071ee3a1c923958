#include "io/format/tir.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/text/parse_number.h"
#include "base/text/shorten.h"
#include "io/file/read_text_file.h"
#include "io/format/text_line.h"

namespace strut {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20U;  // real files have about 20 kB

std::string quote(std::string_view text) { return "'" + shorten(text) + "'"; }

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\v\f\r";
  return strut::trim(text, kBlanks);
}

std::string to_upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

/// Returns the line without its comment; a comment sign inside quotes is text.
std::string_view strip_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\'') quoted = !quoted;
    if (!quoted && (line[i] == '$' || line[i] == '!')) return trim(line.substr(0, i));
  }
  return trim(line);
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto value = parse_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Returns "KEY = value".
std::string describe(const TirEntry& entry) {
  return fmt::format("{} = {}", shorten(entry.key),
                     entry.quoted ? quote(entry.text) : shorten(entry.text));
}

/// Takes the next line off `content`, without its comment; false at the end.
bool take_line(std::string_view& content, TextLine& line) {
  if (content.empty()) return false;
  const std::size_t end = std::min(content.find('\n'), content.size());
  line.text = strip_comment(content.substr(0, end));
  ++line.number;
  content.remove_prefix(std::min(end + 1, content.size()));
  return true;
}

/// Parses "[NAME]".
std::string parse_section(const TextLine& line) {
  if (line.text.back() != ']' || line.text.size() < 3) {
    throw line_error(line, quote(line.text) + ": a section must read [NAME]");
  }
  return to_upper(trim(line.text.substr(1, line.text.size() - 2)));
}

/// Parses "{column names}".
std::string parse_column_names(const TextLine& line) {
  if (line.text.back() != '}') {
    throw line_error(line, quote(line.text) + ": must read {column names}");
  }
  return std::string(trim(line.text.substr(1, line.text.size() - 2)));
}

/// Parses "KEY = value" or "KEY = 'text'".
TirEntry parse_entry(const TextLine& line, const std::string& section) {
  const std::size_t equals = line.text.find('=');
  TirEntry entry{section, to_upper(trim(line.text.substr(0, equals))),
                 std::string(trim(line.text.substr(equals + 1))), false, line.number};
  if (entry.key.empty()) throw line_error(line, quote(line.text) + ": a name must precede '='");
  if (entry.text.empty()) throw line_error(line, shorten(entry.key) + ": a value must follow '='");
  if (!entry.text.starts_with('\'')) return entry;
  if (entry.text.size() < 2 || entry.text.back() != '\'') {
    throw line_error(line, describe(entry) + ": the closing quote is missing");
  }
  entry.text = std::string(trim(std::string_view(entry.text).substr(1, entry.text.size() - 2)));
  entry.quoted = true;
  return entry;
}

/// Parses the numbers of a row, separated by blanks or commas.
std::vector<double> parse_row(const TextLine& line) {
  std::vector<double> row;
  for (std::string_view rest = line.text; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(" \t,"), rest.size());
    const std::optional<double> value = to_number(rest.substr(0, end));
    if (!value) throw line_error(line, quote(rest.substr(0, end)) + ": must be a number");
    row.push_back(*value);
    rest = trim(rest.substr(std::min(end + 1, rest.size())));
  }
  return row;
}

/// Lines of the entries so far, by section and key.
using EntryLines = std::map<std::pair<std::string, std::string>, int>;

void refuse_repeated(const TextLine& line, const TirEntry& entry, EntryLines& lines) {
  const auto [first, is_new] = lines.try_emplace({entry.section, entry.key}, entry.line);
  if (is_new) return;
  throw line_error(line,
                   fmt::format("{}: already given in line {}", describe(entry), first->second));
}

}  // namespace

const TirEntry* TirFile::find(std::string_view key) const {
  const auto it =
      std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key == key; });
  return it == entries.end() ? nullptr : &*it;
}

TirFile parse_tir(std::string_view content, const std::filesystem::path& path) {
  TirFile file{path, {}, {}};
  EntryLines lines;
  std::string section;
  bool in_table = false;
  for (TextLine line{path}; take_line(content, line);) {
    if (line.text.empty()) continue;
    if (line.text.front() == '[') {
      section = parse_section(line);
      in_table = false;
    } else if (line.text.front() == '{') {
      file.tables.push_back({section, parse_column_names(line), {}, line.number});
      in_table = true;
    } else if (line.text.find('=') != std::string_view::npos) {
      file.entries.push_back(parse_entry(line, section));
      refuse_repeated(line, file.entries.back(), lines);
      in_table = false;
    } else if (in_table) {
      file.tables.back().rows.push_back(parse_row(line));
    } else {
      throw line_error(line, quote(line.text) + ": must be KEY = value or [SECTION]");
    }
  }
  return file;
}

TirFile read_tir(const std::filesystem::path& path) {
  return parse_tir(read_text_file(path, kMaxBytes), path);
}

double get_number(const TirFile& file, const TirEntry& entry) {
  const std::optional<double> value = entry.quoted ? std::nullopt : to_number(entry.text);
  if (!value) throw tir_error(file, entry, "must be a finite number");
  return *value;
}

InputError tir_error(const TirFile& file, const TirEntry& entry, const std::string& what) {
  return line_error(file.path, entry.line, fmt::format("{}: {}", describe(entry), what));
}

}  // namespace strut
