#include "io/table/column_name.h"

#include <catch2/catch.hpp>

#include "io/table/csv_cell.h"

namespace strut {
namespace {

TEST_CASE("A header splits into name and unit", "[io]") {
  struct Case {
    const char *header, *name, *unit;
  };
  for (const Case& c : {Case{"AccZ [g]", "AccZ", "g"},
                        {"Plate, Road (m)", "Plate, Road", "m"},
                        {"F / kN", "F", "kN"},
                        {"v/(m/s)", "v", "m/s"},
                        {"v / m/s", "v", "m/s"},
                        {"Force, N", "Force", "N"},
                        {"Kraft in N", "Kraft", "N"},
                        {"a {m/s²}", "a", "m/s^2"},
                        {"Signal [V]", "Signal", "V"},
                        {"ratio [-]", "ratio", "1"},
                        {"speed m/s", "speed m/s", ""},
                        {"Damper (left)", "Damper (left)", ""},
                        {"data [0]", "data [0]", ""},
                        {"Plate, F", "Plate, F", ""},
                        {"body_position_z", "body_position_z", ""},
                        {"[mm]", "[mm]", ""},
                        {"", "", ""}}) {
    CAPTURE(c.header);
    const ColumnName name = split_unit(c.header);
    CHECK(name.name == c.name);
    CHECK(name.unit == c.unit);
  }
}

TEST_CASE("A name without a unit may end with one", "[io]") {
  CHECK(guess_name_unit("disp_mm") == "mm");
  CHECK(guess_name_unit("vel_mm_s") == "mm/s");
  CHECK(guess_name_unit("F_command_N") == "N");
  CHECK(guess_name_unit("acc_m_s2") == "m/s^2");
  CHECK(guess_name_unit("body_position_z").empty());
  CHECK(guess_name_unit("N").empty());
}

TEST_CASE("Cells are numbers with a point or a comma, clock times or missing", "[io]") {
  CHECK(parse_cell_number("+1.5e-3", '.') == 1.5e-3);
  CHECK(parse_cell_number("1,5", ',') == 1.5);
  CHECK_FALSE(parse_cell_number("1,5", '.'));
  CHECK_FALSE(parse_cell_number("1.234,5", ','));  // thousands
  CHECK_FALSE(parse_cell_number("inf", '.'));
  CHECK(parse_cell_clock("01:02:03.25") == 3723.25);
  CHECK(parse_cell_clock("2026-05-03T01:02:03,25Z") == 3723.25);
  CHECK(parse_cell_clock("02:03.25") == 123.25);
  CHECK_FALSE(parse_cell_clock("25:00:00"));
  CHECK_FALSE(parse_cell_clock("1:2:3:4"));
  CHECK_FALSE(parse_cell_clock("ratio 1:x"));
  CHECK(is_missing_cell("NaN"));
  CHECK(is_missing_cell("#N/A"));
  CHECK_FALSE(is_missing_cell("0"));
}

}  // namespace
}  // namespace strut
