#include "base/text/fill_template.h"

#include "base/error/check.h"

namespace strut {
namespace {

constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyz_";

/// Length of the place "@name@" at the start of `text`; 0: there is none.
std::size_t find_place_length(std::string_view text) {
  const std::size_t end = text.find_first_not_of(kNameCharacters, 1);
  const bool is_place = end != std::string_view::npos && end > 1 && text[end] == '@';
  return is_place ? end + 1 : 0;
}

}  // namespace

std::string fill_template(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string filled;
  while (true) {
    const std::size_t begin = text.find('@');
    filled += text.substr(0, begin);
    if (begin == std::string_view::npos) return filled;
    text.remove_prefix(begin);
    const std::size_t length = find_place_length(text);
    if (length == 0) {
      filled += '@';
      text.remove_prefix(1);
      continue;
    }
    const auto value = values.find(std::string(text.substr(1, length - 2)));
    STRUT_CHECK(value != values.end(),
                "template: no value for " + std::string(text.substr(0, length)));
    filled += value->second;
    text.remove_prefix(length);
  }
}

}  // namespace strut
