#include "io/table/csv_cell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "base/text/parse_number.h"

namespace strut {
namespace {

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

/// Removes the date before a time of day, and the time zone behind it.
std::string_view cut_time_of_day(std::string_view cell) {
  const auto date_end = cell.find_last_of("T ");
  if (date_end != std::string_view::npos) cell.remove_prefix(date_end + 1);
  const auto zone = cell.find_first_of("Z+-");
  return cell.substr(0, zone);
}

/// Whether a field is one or two digits below `limit`.
std::optional<double> parse_field(std::string_view text, double limit) {
  if (text.empty() || text.size() > 2) return std::nullopt;
  const auto value = parse_number<unsigned>(text);
  if (!value || *value >= limit) return std::nullopt;
  return *value;
}

/// "56", "56.789", "56,789"
std::optional<double> parse_seconds(std::string_view text) {
  const auto point = text.find_first_of(".,");
  const auto whole = parse_field(text.substr(0, point), 61.0);  // leap seconds
  if (!whole || point == std::string_view::npos) return whole;
  const std::string fraction = "0." + std::string(text.substr(point + 1));
  const auto rest = parse_number<double>(fraction);
  const bool is_digits = fraction.find_first_not_of("0123456789.") == std::string::npos;
  if (!rest || !is_digits) return std::nullopt;
  return *whole + *rest;
}

}  // namespace

std::optional<double> parse_cell_number(std::string_view cell, char decimal) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  std::array<char, 64> buffer;
  if (decimal == ',') {
    // A thousands separator would be misread.
    if (cell.size() > buffer.size() || cell.find('.') != std::string_view::npos) {
      return std::nullopt;
    }
    std::replace_copy(cell.begin(), cell.end(), buffer.begin(), ',', '.');
    cell = {buffer.data(), cell.size()};
  }
  const auto value = parse_number<double>(cell);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  return value;
}

std::optional<double> parse_cell_clock(std::string_view cell) {
  constexpr double kMinute = 60.0, kHour = 3600.0;
  const std::string_view time = cut_time_of_day(cell);
  const auto first = time.find(':');
  if (first == std::string_view::npos) return std::nullopt;
  const auto second = time.find(':', first + 1);
  if (second == std::string_view::npos) {
    const auto minutes = parse_field(time.substr(0, first), 60.0);
    const auto seconds = parse_seconds(time.substr(first + 1));
    if (!minutes || !seconds) return std::nullopt;
    return kMinute * *minutes + *seconds;
  }
  const auto hours = parse_field(time.substr(0, first), 24.0);
  const auto minutes = parse_field(time.substr(first + 1, second - first - 1), 60.0);
  const auto seconds = parse_seconds(time.substr(second + 1));
  if (!hours || !minutes || !seconds) return std::nullopt;
  return kHour * *hours + kMinute * *minutes + *seconds;
}

bool is_missing_cell(std::string_view cell) {
  constexpr const char* kTexts[] = {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--"};
  return std::any_of(std::begin(kTexts), std::end(kTexts),
                     [&](const char* text) { return equals_ignoring_case(cell, text); });
}

}  // namespace strut
