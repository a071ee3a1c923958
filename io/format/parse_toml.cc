#include "io/format/parse_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/text/shorten.h"
#include "io/file/read_text_file.h"
#include "io/format/text_line.h"

namespace strut {
namespace {

// The parser and all functions that walk its tables recurse one level for every bracket and every
// part of a key. Real files need 4 of either.
constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxKeyParts = 32;
constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;
// Names, paths and short notes: longer ones would only make messages unreadable.
constexpr std::size_t kMaxWordBytes = 256;
constexpr std::size_t kMaxStringBytes = 4096;
constexpr std::size_t kMaxDescription = 200;

/// Returns the position after the string whose opening quote is at `begin`; if it is not closed,
/// the end of its line, or of the text for a multi-line string.
std::size_t find_string_end(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const bool escapes = quote == '"';
  const std::string fence(3, quote);
  const bool multiline = text.substr(begin).starts_with(fence);
  for (std::size_t i = begin + (multiline ? 3 : 1); i < text.size(); ++i) {
    if (escapes && text[i] == '\\') {
      ++i;
    } else if (!multiline && (text[i] == quote || text[i] == '\n')) {
      return i + 1;
    } else if (multiline && text.substr(i).starts_with(fence)) {
      // Up to two quotes in front of the fence belong to the string.
      return std::min(text.find_first_not_of(quote, i), i + 5);
    }
  }
  return text.size();
}

/// Nesting, parts and length of the word at a position.
struct Extent {
  std::size_t depth = 0;  // nested arrays and tables
  std::size_t parts = 1;  // parts of a dotted key
  std::size_t word = 0;   // bytes of a key or value without quotes

  void add(char c) {
    const auto is_one_of = [c](std::string_view marks) { return marks.find(c) != marks.npos; };
    if (is_one_of("[{")) ++depth;
    if (is_one_of("]}") && depth > 0) --depth;
    if (c == '.') ++parts;
    if (is_one_of("[]{}=,\n")) parts = 1;
    word = is_one_of("[]{}=,.\n \t") ? 0 : word + 1;
  }
};

/// Refuses texts that would exhaust the stack, and words that no file needs. Recognizes only the
/// strings, comments, brackets and dots of TOML, and agrees with the parser as far as the text is
/// valid.
void check_limits(const std::filesystem::path& path, std::string_view text) {
  Extent extent;
  std::size_t i = 0;
  const auto check = [&](std::size_t value, std::size_t max, const char* fault, const char* unit) {
    if (value <= max) return;
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    throw line_error(path, line + 1,
                     fmt::format("{}; at most {} {} are allowed", fault, max, unit));
  };
  while (i < text.size()) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      const std::size_t end = find_string_end(text, i);
      check(end - i, kMaxStringBytes, "text too long", "bytes");
      i = end;
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else {
      extent.add(c);
      check(extent.depth, kMaxDepth, "arrays and tables nested too deep", "levels");
      check(extent.parts, kMaxKeyParts, "dotted key too long", "parts");
      check(extent.word, kMaxWordBytes, "key or value too long", "bytes");
      ++i;
    }
  }
}

/// Refuses files of other formats by what they are: the parser would complain about their bytes.
void check_format(const std::filesystem::path& path, std::string_view text) {
  struct Format {
    const char* start;
    const char* name;
  };
  static constexpr Format kFormats[] = {{"\x89HDF\r\n", "an HDF5 file"},
                                        {"MATLAB ", "a MATLAB file"},
                                        {"strut ", "a file that strut seals, as a shard or a run"},
                                        {"PK\x03\x04", "an archive (zip)"},
                                        {"\x1f\x8b", "a compressed file (gzip)"},
                                        {"<", "a page or XML file"},
                                        {"{", "a JSON file"}};
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (const auto& [start, name] : kFormats) {
    if (!text.starts_with(start)) continue;
    throw InputError(fmt::format("{}: {}; must be a TOML file", path.string(), name));
  }
}

/// Returns a hint if the file has the extension of a table of data, "" otherwise.
const char* describe_name(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const bool is_table = extension == ".csv" || extension == ".tsv" || extension == ".txt";
  return is_table ? "; is it a table of data?" : "";
}

}  // namespace

std::string read_toml_text(const std::filesystem::path& path) {
  return read_text_file(path, kMaxBytes);
}

toml::table parse_toml(const std::filesystem::path& path, const std::string& text) {
  check_format(path, text);
  check_limits(path, text);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& e) {
    throw line_error(
        path, e.source().begin.line,
        "not valid TOML: " + shorten(e.description(), kMaxDescription) + describe_name(path));
  }
}

std::string join_key(const std::string& table, const std::string& key) {
  return table.empty() ? key : fmt::format("{}.{}", table, key);
}

std::string name_element(const std::string& array, std::size_t index) {
  return fmt::format("{}[{}]", array, index + 1);
}

}  // namespace strut
