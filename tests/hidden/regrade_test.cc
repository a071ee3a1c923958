// Published trials that are graded anew.
#include "tests/hidden/regrade.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/tolerance.h"

namespace strut::hidden {

TEST_CASE("Hidden data: published trials are graded anew, their answers kept", "[unit]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("list.csv",
                                        "# a comment\n"
                                        "dyno,2029,adequate,,idle stroke,0,2.4734e-06,4.18,D\n"
                                        "dyno,2031,right,,handed-over valves,0,0.00318,11.05,B\n"
                                        "dyno,2047,group,damper_hysteresis sensor_lowpass@force,"
                                        "sensor delay,1,0.00038,50.2,A\n"
                                        "dyno,2040,right,\n");
  const std::vector<PublishedTrial> published = read_published(path);
  REQUIRE(published.size() == 4);
  CHECK(published[2].names.size() == 2);
  CHECK(published[1].grades == "B");
  const std::vector<Trial> trials = regrade(published, 2);
  CHECK(trials[1].get_grade() == 'B');
  CHECK(trials[1].faults[0].ratio == Approx(11.05).epsilon(test::tolerance(0.1)));
  CHECK(trials[3].get_grade() == '-');
  // The same for any number of threads.
  CHECK(make_regrade_list(published, regrade(published, 1)) ==
        make_regrade_list(published, trials));
  const std::string report = make_regrade_report(published, trials);
  CHECK_THAT(report, Catch::Contains("| handed-over valves |"));
  CHECK_THAT(report, Catch::Contains("| dyno | B | 0 | 1 | 0 | 0 |"));
  // A low-pass is a delay to the dynamometer's runs: wrong by its name, right by its class.
  CHECK_THAT(report, Catch::Contains("| dyno | truth in printed group | old | 0/1"));
  CHECK_THAT(report, Catch::Contains("| dyno | truth in printed group | new | 1/1"));
}

TEST_CASE("Hidden data: a list of published trials names the line that is wrong", "[io]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("list.csv", "dyno,2029,right,\ndyno,2030,right,,nothing\n");
  CHECK_THROWS_WITH(read_published(path), Catch::Contains("line 2"));
  const std::string unknown = folder.write("fault.csv", "dyno,2029,right,,no such,0,0.1,4.0,D\n");
  CHECK_THROWS_WITH(read_published(unknown), Catch::Contains("no such fault"));
}

}  // namespace strut::hidden
