// Points that are simulated together against each of them by itself, bit by bit.
#include <catch2/catch.hpp>

#include "estimate/simulate_run.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

TEST_CASE(
    "Points of a car in lanes have the bits of each by itself, and one that fails stands alone",
    "[property]") {
  Case base = test::make_bump_case();
  base.maneuver.duration = 0.4;
  const MeasuredRun run = test::measure(base, base, {});
  const std::vector<Unknown> unknowns = {make_parameter({run}, "front_damping"),
                                         make_parameter({run}, "front_stiffness")};
  std::vector<std::vector<double>> points(10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto part = static_cast<double>(i);
    points[i] = {1500.0 + 40.0 * part, 36000.0 + 500.0 * part};
  }
  points[4][1] = 100.0;  // springs that do not carry the car
  const std::vector<RunCurves> together = simulate_points(run, unknowns, points);
  REQUIRE(together.size() == points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    CAPTURE(p);
    const RunCurves alone = simulate_run(run, unknowns, points[p]);
    CHECK(together[p].failure == alone.failure);
    CHECK(together[p].failure.empty() == (p != 4));
    if (p == 4) continue;
    for (const MeasuredChannel& c : run.channels) {
      const auto at = static_cast<std::size_t>(c.channel);
      REQUIRE(together[p].channel[at].size() == run.times.size());
      for (std::size_t t = 0; t < run.times.size(); ++t) {
        const double a = together[p].channel[at][t], b = alone.channel[at][t];
        const bool are_same = a == b || (std::isnan(a) && std::isnan(b));
        REQUIRE(are_same);
      }
    }
    CHECK(together[p].channel[CarChannel::kTime].empty());
  }
}

}  // namespace
}  // namespace strut
