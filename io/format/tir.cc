#include "io/format/tir.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"
#include "base/text/shorten.h"
#include "io/file/read_text_file.h"

namespace strut {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20U;  // real files have some 20 kB

std::string quote(std::string_view text) { return "'" + shorten(text) + "'"; }

std::string_view trim(std::string_view text) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string to_upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

/// The line without its comment; a comment sign inside quotes is text.
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

/// KEY = value
std::string describe(const TirEntry& entry) {
  return shorten(entry.key) + " = " + (entry.quoted ? quote(entry.text) : shorten(entry.text));
}

class Parser {
 public:
  explicit Parser(const std::filesystem::path& path) { file_.path = path; }

  void parse_line(std::string_view line, int number) {
    line_ = number;
    const std::string_view text = strip_comment(line);
    if (text.empty()) return;
    if (text.front() == '[') {
      parse_section(text);
    } else if (text.front() == '{') {
      parse_header(text);
    } else if (text.find('=') != std::string_view::npos) {
      parse_entry(text);
    } else {
      parse_row(text);
    }
  }

  TirFile take() { return std::move(file_); }

 private:
  InputError error(const std::string& what) const {
    return InputError(file_.path.string() + ":" + std::to_string(line_) + ": " + what);
  }

  void parse_section(std::string_view text) {
    if (text.back() != ']' || text.size() < 3) {
      throw error(quote(text) + ": a section must read [NAME]");
    }
    section_ = to_upper(trim(text.substr(1, text.size() - 2)));
    in_table_ = false;
  }

  void parse_header(std::string_view text) {
    if (text.back() != '}') throw error(quote(text) + ": must read {column names}");
    file_.tables.push_back(
        {section_, std::string(trim(text.substr(1, text.size() - 2))), {}, line_});
    in_table_ = true;
  }

  void parse_entry(std::string_view text) {
    const std::size_t equals = text.find('=');
    TirEntry entry{section_, to_upper(trim(text.substr(0, equals))),
                   std::string(trim(text.substr(equals + 1))), false, line_};
    if (entry.key.empty()) throw error(quote(text) + ": a name must precede '='");
    if (entry.text.starts_with('\'')) {
      if (entry.text.size() < 2 || entry.text.back() != '\'') {
        throw error(describe(entry) + ": the closing quote is missing");
      }
      entry.text = std::string(trim(std::string_view(entry.text).substr(1, entry.text.size() - 2)));
      entry.quoted = true;
    } else if (entry.text.empty()) {
      throw error(shorten(entry.key) + ": a value must follow '='");
    }
    check_new(entry);
    file_.entries.push_back(std::move(entry));
    in_table_ = false;
  }

  void check_new(const TirEntry& entry) {
    const auto [first, is_new] = lines_.try_emplace({entry.section, entry.key}, entry.line);
    if (is_new) return;
    throw error(describe(entry) + ": already given in line " + std::to_string(first->second));
  }

  void parse_row(std::string_view text) {
    if (!in_table_) throw error(quote(text) + ": must be KEY = value or [SECTION]");
    std::vector<double> row;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t end = std::min(rest.find_first_of(" \t,"), rest.size());
      const std::optional<double> value = to_number(rest.substr(0, end));
      if (!value) throw error(quote(rest.substr(0, end)) + ": must be a number");
      row.push_back(*value);
      rest = trim(rest.substr(std::min(end + 1, rest.size())));
    }
    file_.tables.back().rows.push_back(std::move(row));
  }

  TirFile file_;
  std::map<std::pair<std::string, std::string>, int> lines_;  // by section and key
  std::string section_;
  bool in_table_ = false;
  int line_ = 0;
};

}  // namespace

const TirEntry* TirFile::find(std::string_view key) const {
  const auto it =
      std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key == key; });
  return it == entries.end() ? nullptr : &*it;
}

TirFile parse_tir(std::string_view content, const std::filesystem::path& path) {
  Parser parser(path);
  for (int line = 1; !content.empty(); ++line) {
    const std::size_t end = std::min(content.find('\n'), content.size());
    parser.parse_line(content.substr(0, end), line);
    content.remove_prefix(std::min(end + 1, content.size()));
  }
  return parser.take();
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
  return InputError(file.path.string() + ":" + std::to_string(entry.line) + ": " + describe(entry) +
                    ": " + what);
}

}  // namespace strut
