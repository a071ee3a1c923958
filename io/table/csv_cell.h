// Cells of text tables: numbers, clock times, missing samples.
#pragma once

#include <optional>
#include <string_view>

namespace strut {

/// Returns the finite number that the cell holds, with `decimal` ('.' or ',') as decimal sign; a
/// leading '+' is allowed. Nothing for other texts, infinities and NaN.
std::optional<double> parse_cell_number(std::string_view cell, char decimal);

/// Returns the time of day [s] of "12:34:56.789", alone or behind a date ("2026-05-03T12:34:56Z",
/// "03.05.2026 12:34:56,789"), or of "34:56.789", minutes and seconds. A time zone is ignored.
/// Nothing for other texts.
std::optional<double> parse_cell_clock(std::string_view cell);

/// Whether a cell stands for a missing sample: empty, "nan", "na", "n/a", "null", "-", in any case.
bool is_missing_cell(std::string_view cell);

}  // namespace strut
