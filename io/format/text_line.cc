#include "io/format/text_line.h"

#include <fmt/format.h>

namespace strut {

InputError line_error(const std::filesystem::path& path, std::int64_t line,
                      const std::string& what) {
  return InputError(fmt::format("{}:{}: {}", path.string(), line, what));
}

InputError line_error(const TextLine& line, const std::string& what) {
  return line_error(line.path, line.number, what);
}

std::string_view trim(std::string_view text, std::string_view blanks) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace strut
