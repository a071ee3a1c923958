// Cells of text tables: numbers, clock times, missing samples.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace strut {

/// Returns the finite number that the cell holds, with `decimal` ('.' or ',') as decimal sign; a
/// leading '+' is allowed, and marks between thousands where they cannot be decimal signs:
/// "1,234.5", "1'234", but not "1,234". Nothing for other texts, infinities and NaN.
std::optional<double> parse_cell_number(std::string_view cell, char decimal);

/// A clock time, with the date where the cell has one.
struct CellClock {
  double time = 0.0;    // s, since midnight or, of minutes and seconds, since the full hour
  double period = 0.0;  // s, after which the clock begins anew
  /// Days since 1970 of the date, read with the day before the month and with the month before the
  /// day; nothing where that is no date.
  std::array<std::optional<int>, 2> days{};
};

/// Reads "12:34:56.789", alone or behind a date ("2026-05-03T12:34:56Z", "03.05.2026 12:34:56,789",
/// "5/3/2026 1:34:56 PM"), or "34:56.789", minutes and seconds. A time zone (Z, +02:00, -0500)
/// makes the time that of UTC; it may then be outside of the day. Nothing for other texts.
std::optional<CellClock> parse_cell_clock(std::string_view cell);

/// Reads the clock of a satellite receiver: 134512.25 is 13:45:12.25. Nothing for other texts.
std::optional<CellClock> parse_compact_clock(std::string_view cell);

/// Turns the clock times of successive rows into time that runs on, over midnight and full hours.
class RunningClock {
 public:
  /// Returns the time [s] since the first row.
  double advance(const CellClock& clock);

 private:
  std::optional<CellClock> last_;
  double begin_ = 0.0, base_ = 0.0;  // s: time of the first row; added to the clock's
};

/// Whether a cell stands for a missing sample: empty, "nan", "na", "n/a", "null", "-", in any case.
bool is_missing_cell(std::string_view cell);

}  // namespace strut
