#include "io/table/csv_cell.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
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

/// Marks between the thousands of a number; the last two are blanks that do not break a line.
constexpr std::array<std::string_view, 6> kThousandsMarks = {",", ".",        "'",
                                                             " ", "\xc2\xa0", "\xe2\x80\xaf"};

bool are_digits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// "1,234.5", "-1.234.567" (with a decimal comma) or "1'234" with a decimal point and without its
/// marks. Nothing where one mark alone could be a decimal sign, and for other texts.
std::optional<std::string> remove_thousands(std::string_view cell, char decimal) {
  const auto end = std::min(cell.find(decimal), cell.size());
  const bool is_negative = cell.starts_with('-');
  std::string_view whole = cell.substr(0, end);
  if (is_negative) whole.remove_prefix(1);
  if (whole.empty() || whole.front() < '1' || whole.front() > '9') return std::nullopt;
  for (const std::string_view mark : kThousandsMarks) {
    auto at = whole.find(mark);
    if (mark.front() == decimal || at == std::string_view::npos) continue;
    if (at == 0 || at > 3 || !are_digits(whole.substr(0, at))) return std::nullopt;
    std::string digits(whole.substr(0, at));
    int marks = 0;
    for (; at < whole.size(); at += mark.size() + 3, ++marks) {
      const std::string_view group = whole.substr(std::min(at + mark.size(), whole.size()), 3);
      if (!whole.substr(at).starts_with(mark) || group.size() != 3 || !are_digits(group)) {
        return std::nullopt;
      }
      digits += group;
    }
    const bool may_be_decimal = marks == 1 && end == cell.size() && (mark == "," || mark == ".");
    const std::string_view fraction = cell.substr(std::min(end + 1, cell.size()));
    if (may_be_decimal || !are_digits(fraction)) return std::nullopt;
    return (is_negative ? "-" : "") + digits + "." + std::string(fraction) + "0";
  }
  return std::nullopt;
}

constexpr double kMinute = 60.0, kHour = 3600.0, kDay = 86400.0;

/// The number of one or two digits, below `limit`.
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

std::optional<int> count_days(int year, int month, int day) {
  if (month > 12 || day > 31) return std::nullopt;  // std::chrono takes them modulo 256
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count();
}

/// The date's days since 1970, as CellClock::days.
std::array<std::optional<int>, 2> parse_date(std::string_view text) {
  std::array<int, 3> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto end = i + 1 < fields.size() ? text.find_first_of("-./") : text.size();
    if (end == std::string_view::npos) return {};
    const auto value = parse_number<unsigned>(text.substr(0, end));
    if (!value || *value > 9999U) return {};
    fields[i] = static_cast<int>(*value);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  constexpr int kFirstYear = 100;  // two digits are of this century
  const auto [first, second, third] = fields;
  if (first >= kFirstYear) {
    const auto days = count_days(first, second, third);
    return {days, days};
  }
  const int year = third < kFirstYear ? 2000 + third : third;
  return {count_days(year, second, first), count_days(year, first, second)};
}

/// Offset [s] of a time zone, "Z" or "+02:00"; nothing where the text is none.
std::optional<double> parse_zone(std::string_view text) {
  if (text == "Z") return 0.0;
  if (text.size() < 3) return std::nullopt;
  const auto hours = parse_field(text.substr(1, 2), 24.0);
  std::string_view rest = text.substr(3);
  if (rest.starts_with(':')) rest.remove_prefix(1);
  const auto minutes = rest.empty() ? std::optional(0.0) : parse_field(rest, 60.0);
  if (!hours || !minutes) return std::nullopt;
  const double offset = kHour * *hours + kMinute * *minutes;
  return text.front() == '-' ? -offset : offset;
}

constexpr std::size_t kHalfDayLength = 3;

/// 0 for a cell that ends in " AM", 1 for " PM"; nothing for others.
std::optional<int> find_half_day(std::string_view cell) {
  if (cell.size() < kHalfDayLength) return std::nullopt;
  const std::string_view end = cell.substr(cell.size() - kHalfDayLength);
  if (equals_ignoring_case(end, " am")) return 0;
  if (equals_ignoring_case(end, " pm")) return 1;
  return std::nullopt;
}

/// "12:34:56.789" or "34:56.789"
std::optional<CellClock> parse_time_of_day(std::string_view time) {
  const auto first = time.find(':');
  if (first == std::string_view::npos) return std::nullopt;
  const auto second = time.find(':', first + 1);
  if (second == std::string_view::npos) {
    const auto minutes = parse_field(time.substr(0, first), 60.0);
    const auto seconds = parse_seconds(time.substr(first + 1));
    if (!minutes || !seconds) return std::nullopt;
    return CellClock{kMinute * *minutes + *seconds, kHour};
  }
  const auto hours = parse_field(time.substr(0, first), 24.0);
  const auto minutes = parse_field(time.substr(first + 1, second - first - 1), 60.0);
  const auto seconds = parse_seconds(time.substr(second + 1));
  if (!hours || !minutes || !seconds) return std::nullopt;
  return CellClock{kHour * *hours + kMinute * *minutes + *seconds, kDay};
}

}  // namespace

std::optional<double> parse_cell_number(std::string_view cell, char decimal) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  std::array<char, 64> buffer;
  std::string_view text = cell;
  if (decimal == ',') {
    if (cell.size() > buffer.size()) return std::nullopt;
    std::replace_copy(cell.begin(), cell.end(), buffer.begin(), ',', '.');
    text = {buffer.data(), cell.size()};
  }
  const bool has_mark = decimal == ',' && cell.find('.') != std::string_view::npos;
  const auto value = has_mark ? std::nullopt : parse_number<double>(text);
  if (value) return std::isfinite(*value) ? value : std::nullopt;
  const auto grouped = remove_thousands(cell, decimal);
  return grouped ? parse_number<double>(*grouped) : std::nullopt;
}

std::optional<CellClock> parse_cell_clock(std::string_view cell) {
  if (const auto half = find_half_day(cell)) {
    auto clock = parse_cell_clock(cell.substr(0, cell.size() - kHalfDayLength));
    if (!clock) return std::nullopt;
    clock->time = std::fmod(clock->time, 0.5 * kDay) + *half * 0.5 * kDay;
    return clock;
  }
  const auto date_end = cell.find_last_of("T ");
  const std::string_view date = date_end == std::string_view::npos ? "" : cell.substr(0, date_end);
  std::string_view time = cell.substr(date_end == std::string_view::npos ? 0 : date_end + 1);
  const auto zone = std::min(time.find_first_of("Z+-"), time.size());
  auto clock = parse_time_of_day(time.substr(0, zone));
  if (!clock) return std::nullopt;
  if (!date.empty()) clock->days = parse_date(date);
  if (const auto offset = parse_zone(time.substr(zone))) clock->time -= *offset;
  return clock;
}

std::optional<CellClock> parse_compact_clock(std::string_view cell) {
  constexpr std::size_t kDigits = 6;
  if (cell.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
  const std::size_t point = std::min(cell.find('.'), cell.size());
  if (point == 0 || point > kDigits) return std::nullopt;
  const std::string digits = std::string(kDigits - point, '0') + std::string(cell);
  return parse_time_of_day(digits.substr(0, 2) + ":" + digits.substr(2, 2) + ":" +
                           digits.substr(4));
}

double RunningClock::advance(const CellClock& clock) {
  if (!last_) {
    begin_ = clock.time;
  } else {
    // A date read in the wrong order of day and month jumps by a month.
    std::optional<int> days;
    for (std::size_t order = 0; order < clock.days.size(); ++order) {
      if (!clock.days[order] || !last_->days[order]) continue;
      const int passed = *clock.days[order] - *last_->days[order];
      if (!days || std::abs(passed) < std::abs(*days)) days = passed;
    }
    if (days) {
      base_ += kDay * *days;
    } else if (clock.time < last_->time - 0.5 * clock.period) {
      base_ += clock.period;  // unless the clock was set back by less
    }
  }
  last_ = clock;
  return base_ + clock.time - begin_;
}

bool is_missing_cell(std::string_view cell) {
  constexpr const char* kTexts[] = {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--"};
  return std::any_of(std::begin(kTexts), std::end(kTexts),
                     [&](const char* text) { return equals_ignoring_case(cell, text); });
}

}  // namespace strut
