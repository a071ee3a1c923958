// Numbers from text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace strut {

/// Returns the number that the whole text represents; nothing where it is not exactly one number.
/// Reads as std::from_chars: no locale, no white space, no leading '+'; "nan" and "inf" are
/// numbers.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace strut
