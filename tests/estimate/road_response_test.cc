// Responses to a road, section by section, against whole runs over the changed road.
#include <catch2/catch.hpp>
#include <cmath>

#include "estimate/reading_model.h"
#include "estimate/readings.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

using test::tolerance;

constexpr Eigen::Index kLeft = 70, kRight = 60;  // coefficients of the tracks

/// A car on waves of 2 mm, which it meets at once.
Case make_rough_case() {
  Case c = test::make_bump_case();
  ManeuverSpec& m = c.maneuver;
  m.rough[0] = {-m.bump_distance - 4.0, 0.5, {}};
  m.rough[1] = {-m.bump_distance - 3.8, 0.55, {}};
  for (Eigen::Index i = 0; i < kLeft; ++i) {
    m.rough[0].coefficients.push_back(2e-3 * std::sin(0.9 * static_cast<double>(i)));
  }
  for (Eigen::Index i = 0; i < kRight; ++i) {
    m.rough[1].coefficients.push_back(2e-3 * std::cos(0.7 * static_cast<double>(i)));
  }
  return c;
}

Eigen::MatrixXd calc_columns(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                             int threads) {
  LinearizeOptions options;
  options.threads = threads;
  const auto model = make_readings({run}, unknowns, options);
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(model->reading_count()), 0);
  const auto take = [&](Eigen::Index first, const Eigen::MatrixXd& part) {
    REQUIRE(first == columns.cols());
    columns.conservativeResize(Eigen::NoChange, first + part.cols());
    columns.rightCols(part.cols()) = part;
  };
  REQUIRE(model->linearize_road(list_starts(unknowns), 0, take).empty());
  return columns;
}

TEST_CASE("Derivatives by a road are those of whole runs over it", "[unit]") {
  Case known = make_rough_case();
  // Without effects, with one that adds states, and with a sensor that reads late.
  known.vehicle.effects =
      GENERATE(EffectSettings{}, EffectSettings{{"damper_hysteresis", "rear", {3e-3}}},
               EffectSettings{{"sensor_lowpass", "imu_acceleration_z", {0.02}},
                              {"sensor_bias", "imu_acceleration_z", {3.0}}});
  const MeasuredRun run = test::measure(known, known, {});
  const std::vector<Unknown> unknowns = {make_parameter({run}, "front_damping")};
  const Eigen::MatrixXd columns = calc_columns(run, unknowns, 1);
  REQUIRE(columns.cols() == kLeft + kRight);
  CHECK(columns == calc_columns(run, unknowns, 2));
  constexpr double kHeight = 1e-5;  // m
  for (const Eigen::Index k : {5, 12, 20, 75, 90}) {
    CAPTURE(k);
    const auto track = static_cast<std::size_t>(k / kLeft);
    const auto number = static_cast<std::size_t>(k % kLeft);
    Eigen::VectorXd side[2];
    for (const int sign : {0, 1}) {
      MeasuredRun changed = run;
      double& height = changed.setup.car().maneuver.rough[track].coefficients[number];
      height += sign == 0 ? -kHeight : kHeight;
      side[sign] = make_readings({changed}, unknowns, {})->evaluate(list_starts(unknowns)).residual;
    }
    const Eigen::VectorXd truth = (side[1] - side[0]).head(columns.rows()) / (2.0 * kHeight);
    const Eigen::VectorXd error = columns.col(k) - truth;
    REQUIRE(truth.norm() > 0.0);
    CHECK(error.norm() < tolerance(0.025) * truth.norm());
    // The last readings, and the first, which a coefficient under a wheel moves at once.
    for (const Eigen::Index row : {Eigen::Index{0}, Eigen::Index{1}, columns.rows() - 1}) {
      CHECK(std::abs(error(row)) < tolerance(0.1) * truth.cwiseAbs().maxCoeff());
    }
  }
  // What no wheel meets before the run ends.
  CHECK(columns.col(kLeft - 1).isZero(0.0));
  CHECK(columns.col(kLeft + kRight - 1).isZero(0.0));
}

TEST_CASE("One rough track beside a smooth one has derivatives by its coefficients alone",
          "[unit]") {
  Case known = make_rough_case();
  const MeasuredRun both = test::measure(known, known, {});
  MeasuredRun one = both;
  one.setup.car().maneuver.rough[0].coefficients.assign(kLeft, 0.0);
  MeasuredRun alone = one;
  alone.setup.car().maneuver.rough[0].coefficients.clear();
  const std::vector<Unknown> unknowns = {make_parameter({both}, "front_damping")};
  const Eigen::MatrixXd level = calc_columns(one, unknowns, 1);
  const Eigen::MatrixXd columns = calc_columns(alone, unknowns, 1);
  REQUIRE(columns.cols() == kRight);
  CHECK((columns - level.rightCols(kRight)).norm() < tolerance(1e-6) * columns.norm());
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
