// Names of a file's columns and the units that stand beside them.
#pragma once

#include <string>
#include <string_view>

namespace strut {

struct ColumnName {
  std::string name, unit;  // unit in its normal spelling (normalize_unit); "": none
};

/// Splits "AccZ [g]", "Plate, Road (m)", "F / kN", "Force, N" or "Force in N" into name and unit.
/// Text in brackets [] or {} at the end is a unit, text in parentheses or behind a slash, a comma
/// or "in" only where it is a known one (is_known_unit); otherwise it belongs to the name.
ColumnName split_unit(std::string_view header);

/// Returns the unit of a cell of a line of units: "mm", "[mm]", "(mm)"; "" for "-" and "1".
std::string parse_unit_cell(std::string_view cell);

/// Whether a cell may stand in a line of units: empty, "-", a known unit, or any text in brackets.
bool is_unit_cell(std::string_view cell);

/// The unit that a name without one ends with, such as "disp_mm", "vel_mm_s", "AccZ_g": a guess;
/// "" if there is none.
std::string guess_name_unit(std::string_view name);

}  // namespace strut
