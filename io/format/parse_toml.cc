#include "io/format/parse_toml.h"

#include <algorithm>
#include <string_view>

#include "base/error/input_error.h"
#include "base/text/shorten.h"
#include "io/file/read_text_file.h"

namespace strut {
namespace {

// The parser and all that walks its tables recurse a level for every bracket and every part of a
// key. Real files need 4 of either.
constexpr int kMaxDepth = 32;
constexpr int kMaxKeyParts = 32;
constexpr std::size_t kMaxBytes = std::size_t{16} << 20U;
// Names, paths and short notes: longer ones would only make messages that nobody can read.
constexpr std::size_t kMaxWordBytes = 256;
constexpr std::size_t kMaxStringBytes = 4096;
constexpr std::size_t kMaxDescription = 200;

InputError error_at(const std::filesystem::path& path, std::string_view before,
                    const std::string& what) {
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  return InputError(path.string() + ":" + std::to_string(line) + ": " + what);
}

/// Place behind the string whose opening quote is at `begin`; where it is not closed, the end of
/// its line, or of the text for one of many lines.
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

/// Refuses what would exhaust the stack, and words that no file needs. Reads no more of TOML than
/// strings, comments, brackets and dots, and agrees with the parser as far as the text is valid.
void check_limits(const std::filesystem::path& path, std::string_view text) {
  int depth = 0, parts = 1;
  std::size_t word = 0;  // bytes of a key or value without quotes
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      const std::size_t end = find_string_end(text, i);
      if (end - i > kMaxStringBytes) {
        throw error_at(
            path, text.substr(0, i),
            "text too long; at most " + std::to_string(kMaxStringBytes) + " bytes are allowed");
      }
      i = end;
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') depth = std::max(depth - 1, 0);
    if (c == '.') ++parts;
    if (std::string_view("[]{}=,\n").find(c) != std::string_view::npos) parts = 1;
    word = std::string_view("[]{}=,.\n \t").find(c) == std::string_view::npos ? word + 1 : 0;
    if (depth > kMaxDepth) {
      throw error_at(path, text.substr(0, i),
                     "arrays and tables nested too deep; at most " + std::to_string(kMaxDepth) +
                         " levels are allowed");
    }
    if (parts > kMaxKeyParts) {
      throw error_at(
          path, text.substr(0, i),
          "dotted key too long; at most " + std::to_string(kMaxKeyParts) + " parts are allowed");
    }
    if (word > kMaxWordBytes) {
      throw error_at(
          path, text.substr(0, i),
          "key or value too long; at most " + std::to_string(kMaxWordBytes) + " bytes are allowed");
    }
    ++i;
  }
}

}  // namespace

std::string read_toml_text(const std::filesystem::path& path) {
  return read_text_file(path, kMaxBytes);
}

toml::table parse_toml(const std::filesystem::path& path, const std::string& text) {
  check_limits(path, text);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& e) {
    throw InputError(path.string() + ":" + std::to_string(e.source().begin.line) +
                     ": not valid TOML: " + shorten(e.description(), kMaxDescription));
  }
}

}  // namespace strut
