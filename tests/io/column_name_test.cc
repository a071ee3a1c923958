#include "io/table/column_name.h"

#include <array>
#include <catch2/catch.hpp>
#include <optional>

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
  CHECK(parse_cell_number("1.234,5", ',') == 1234.5);
  CHECK(parse_cell_number("-12,345,678", '.') == -12345678.0);
  CHECK(parse_cell_number("+1,234.25", '.') == 1234.25);
  CHECK(parse_cell_number("1'234'567.5", '.') == 1234567.5);
  CHECK(parse_cell_number("1'234", '.') == 1234.0);
  CHECK(parse_cell_number("12\xc2\xa0"
                          "345,5",
                          ',') == 12345.5);
  // One mark may be a decimal sign; groups have three digits.
  CHECK_FALSE(parse_cell_number("1,234", '.'));
  CHECK_FALSE(parse_cell_number("1.234", ','));
  for (const char* text :
       {"1234,567.5", "1,23.5", "1,2345.5", ",123.5", "1,234.5.6", "1,234.5e3", "1,,234.5",
        "1,234,", "1,234.5x", "x,234.5", "--1,234.5", "0,123,456", "00 123"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_cell_number(text, '.'));
  }
  CHECK_FALSE(parse_cell_number("inf", '.'));
  const auto read_time = [](const char* cell) { return parse_cell_clock(cell).value().time; };
  CHECK(read_time("01:02:03.25") == 3723.25);
  CHECK(read_time("2026-05-03T01:02:03,25Z") == 3723.25);
  CHECK(read_time("2026-05-03T01:02:03.25+01:00") == 123.25);
  CHECK(read_time("2026-05-03T01:02:03.25-0130") == 3723.25 + 5400.0);
  CHECK(read_time("12:02:03.25 AM") == 123.25);
  CHECK(read_time("1:02:03.25 pm") == 13.0 * 3600.0 + 123.25);
  CHECK(read_time("02:03.25") == 123.25);
  CHECK(parse_compact_clock("010203.25").value().time == 3723.25);
  CHECK(parse_compact_clock("203.25").value().time == 123.25);
  CHECK_FALSE(parse_compact_clock("017000"));
  CHECK_FALSE(parse_compact_clock("1-2"));
  CHECK_FALSE(parse_cell_clock("25:00:00"));
  CHECK_FALSE(parse_cell_clock("1:2:3:4"));
  CHECK_FALSE(parse_cell_clock("ratio 1:x"));
  // Days since 1970: 3 May 2026 is 20576, 5 March 20517.
  using Days = std::array<std::optional<int>, 2>;
  CHECK(parse_cell_clock("2026-05-03 01:02:03")->days == Days{20576, 20576});
  CHECK(parse_cell_clock("03.05.26 01:02:03")->days == Days{20576, 20517});
  CHECK(parse_cell_clock("31/12/2026 01:02:03")->days == Days{20818, std::nullopt});
  CHECK(parse_cell_clock("3 x 01:02:03")->days == Days{});
  CHECK(is_missing_cell("NaN"));
  CHECK(is_missing_cell("#N/A"));
  CHECK_FALSE(is_missing_cell("0"));
}

}  // namespace
}  // namespace strut
