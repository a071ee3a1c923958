#include "io/table/summary.h"

#include <catch2/catch.hpp>

#include "io/store/measurement.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using test::TemporaryFolder;

TEST_CASE("A clock's rate, jitter and gaps are measured", "[io]") {
  std::vector<double> times;
  for (int i = 0; i < 100; ++i) {
    if (i != 40 && i != 41 && i != 70) times.push_back(0.01 * i);
  }
  const ClockSummary clock = summarize_clock(times);
  CHECK(clock.interval == Approx(0.01));
  CHECK(clock.jitter < 1e-12);
  CHECK(clock.gaps == 2);
  CHECK(clock.dropped == 3);
  CHECK(clock.first_gap == Approx(0.39));
  std::vector<double> uneven;
  uneven.reserve(100);
  for (int i = 0; i < 100; ++i) uneven.push_back(0.01 * i + (i % 2 == 0 ? 0.003 : 0.0));
  CHECK(summarize_clock(uneven).gaps == 0);  // intervals of 7 and 13 ms
  CHECK(summarize_clock(uneven).jitter == Approx(0.003).epsilon(0.01));
}

TEST_CASE("Columns are summarized, with their clock and what is odd", "[io]") {
  const TemporaryFolder folder;
  std::string text = "Time (1),force_N,rest,Time_slow [ms],temp,note\n";
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(0.01 * i) + "," + std::to_string(i % 20 < 6 ? 5.0 : 0.1 * (i % 20)) +
            ",7," +
            (i < 4 ? std::to_string(100 * i) + "," + std::to_string(20 + i) : std::string(",")) +
            ",ok\n";
  }
  const auto path = folder.write("a.csv", text);
  const TableSummary table = summarize_table(*open_table_file(path, MeasuredPart::kHistory));
  REQUIRE(table.columns.size() == 6);
  CHECK(table.columns[0].is_clock);
  CHECK(table.columns[0].times.interval == Approx(0.01));
  CHECK(table.columns[1].guessed_unit == "N");
  CHECK(table.columns[1].clock == 0);
  CHECK(table.columns[1].remarks.at(0) == "6 samples in a row at its maximum");
  CHECK(table.columns[2].remarks.at(0) == "constant");
  CHECK(table.columns[3].is_clock);
  CHECK(table.columns[3].times.interval == Approx(0.1));  // s
  CHECK(table.columns[4].clock == 3);
  CHECK(table.columns[4].missing == 36);
  CHECK(table.columns[4].mean == Approx(21.5));
  CHECK_FALSE(table.columns[5].fault.empty());
}

TEST_CASE("A time that does not ascend is said to be none, and no other column takes its place",
          "[io]") {
  const TemporaryFolder folder;
  const auto summarize = [&](const std::string& times) {
    return summarize_table(
        *open_table_file(folder.write("a.csv", "t,F\n" + times), MeasuredPart::kHistory));
  };
  const TableSummary back = summarize("0,1\n0.1,2\n0.05,3\n0.2,4\n");
  CHECK_FALSE(back.columns[0].is_clock);
  CHECK_FALSE(back.columns[1].is_clock);
  REQUIRE(back.columns[0].remarks.size() == 1);
  CHECK(back.columns[0].remarks[0] == "no time: its value 3 is 0.05 after 0.1");
  CHECK(summarize("0,1\n,2\n0.2,4\n").columns[0].remarks.front() ==
        "no time: its value 2 is missing");
}

TEST_CASE("Names that say time", "[io]") {
  for (const char* name : {"t", "Time", "TIME (2)", "t_s", "time_ms", "Zeit", "timestamp"}) {
    CHECK(is_time_name(name));
  }
  for (const char* name : {"", "tire", "time_to_live", "displacement", "s"}) {
    CHECK_FALSE(is_time_name(name));
  }
}

}  // namespace
}  // namespace strut
