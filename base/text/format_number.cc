#include "base/text/format_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace strut {

std::string format_number(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string format_rounded(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::general, 6);
  return {buffer.data(), result.ptr};
}

std::string format_significant(double value, int digits) {
  const double size = std::abs(value);
  if (!std::isfinite(value) || size == 0.0 || size < 1e-4 || size >= 1e6) {
    return fmt::format("{:.{}g}", value, digits);
  }
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  const double unit = std::pow(10.0, -decimals);
  return decimals > 0 ? fmt::format("{:.{}f}", value, decimals)
                      : fmt::format("{:.0f}", std::round(value / unit) * unit);
}

std::string format_to_error(double value, double error) {
  constexpr double kSmallest = 1e-12;  // relative to the value: fewer digits than a double has
  if (!std::isfinite(value) || !(error > kSmallest * std::abs(value)) || !std::isfinite(error)) {
    return format_significant(value);
  }
  const int place = static_cast<int>(std::floor(std::log10(error))) - 1;
  const int size = value == 0.0 ? place : static_cast<int>(std::floor(std::log10(std::abs(value))));
  return format_significant(value, std::max(2, size - place + 1));
}

}  // namespace strut
