// Lines of text files, their parts, and errors that name them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error/input_error.h"

namespace strut {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // UTF-8

/// A line of a file; numbers start at 1.
struct TextLine {
  const std::filesystem::path& path;
  int number = 0;
  std::string_view text = {};
};

/// Returns "PATH:LINE: WHAT" as an error.
InputError line_error(const std::filesystem::path& path, std::int64_t line,
                      const std::string& what);
InputError line_error(const TextLine& line, const std::string& what);

/// Returns `text` without the characters of `blanks` at both ends.
std::string_view trim(std::string_view text, std::string_view blanks);

}  // namespace strut
