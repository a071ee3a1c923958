// Responses to a road, section by section, against whole runs over the changed road.
#include <catch2/catch.hpp>
#include <cmath>

#include "estimate/reading_model.h"
#include "estimate/readings.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

using test::tolerance;

constexpr Eigen::Index kCount = 70;  // coefficients of a track

/// A car on waves of 2 mm, which it meets at once.
Case make_rough_case() {
  Case c = test::make_bump_case();
  ManeuverSpec& m = c.maneuver;
  m.rough.fill({-m.bump_distance - 4.0, 0.5, {}});
  for (Eigen::Index i = 0; i < kCount; ++i) {
    m.rough[0].coefficients.push_back(2e-3 * std::sin(0.9 * static_cast<double>(i)));
    m.rough[1].coefficients.push_back(2e-3 * std::cos(0.7 * static_cast<double>(i)));
  }
  return c;
}

TEST_CASE("Derivatives by a road are those of whole runs over it", "[unit]") {
  Case known = make_rough_case();
  // Without effects, with one that adds states, and with a sensor that reads late.
  known.vehicle.effects =
      GENERATE(EffectSettings{}, EffectSettings{{"damper_hysteresis", "rear", {3e-3}}},
               EffectSettings{{"sensor_lowpass", "imu_acceleration_z", {0.02}}});
  const MeasuredRun run = test::measure(known, known, {});
  std::vector<Unknown> unknowns = {make_parameter({run}, "front_damping")};
  const std::vector<double> values = list_starts(unknowns);
  const auto model = make_readings({run}, unknowns, {});
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(model->reading_count()), 2 * kCount);
  REQUIRE(model
              ->linearize_road(values, 0,
                               [&](Eigen::Index first, const Eigen::MatrixXd& part) {
                                 columns.middleCols(first, part.cols()) = part;
                               })
              .empty());
  constexpr double kHeight = 1e-5;  // m
  for (const Eigen::Index k : {5, 12, 20, 75, 90}) {
    CAPTURE(k);
    Eigen::VectorXd side[2];
    for (const int sign : {0, 1}) {
      MeasuredRun changed = run;
      auto& track = changed.setup.car().maneuver.rough[static_cast<std::size_t>(k / kCount)];
      track.coefficients[static_cast<std::size_t>(k % kCount)] += sign == 0 ? -kHeight : kHeight;
      side[sign] = make_readings({changed}, unknowns, {})->evaluate(values).residual;
    }
    const Eigen::VectorXd truth = (side[1] - side[0]).head(columns.rows()) / (2.0 * kHeight);
    REQUIRE(truth.norm() > 0.0);
    CHECK((columns.col(k) - truth).norm() < tolerance(0.025) * truth.norm());
  }
  // What no wheel meets before the run ends.
  CHECK(columns.col(kCount - 1).isZero(0.0));
}

TEST_CASE("A road that cannot be driven on says why there are no derivatives", "[unit]") {
  Case known = make_rough_case();
  const MeasuredRun run = test::measure(known, known, {});
  const std::vector<Unknown> unknowns = {make_parameter({run}, "front_stiffness")};
  const auto model = make_readings({run}, unknowns, {});
  CHECK_FALSE(model->linearize_road({100.0}, 0, [](Eigen::Index, const Eigen::MatrixXd&) {})
                  .empty());  // springs that do not carry the car
}

}  // namespace
}  // namespace strut
