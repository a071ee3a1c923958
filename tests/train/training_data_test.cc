// Metrics, normalization and split of training data.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/test_car.h"
#include "train/data/metrics.h"
#include "train/data/normalizer.h"
#include "train/data/split.h"

namespace strut {
namespace {

using test::tolerance;

TEST_CASE("The five metrics of an identification agree with a worked example", "[unit]") {
  // By hand: errors 1, -2, 0, 1; mean of the references 25.
  const std::vector<double> reference = {10.0, 20.0, 30.0, 40.0};
  const std::vector<double> predicted = {9.0, 22.0, 30.0, 39.0};
  const Metrics m = calc_metrics(reference, predicted);
  CHECK(m.largest_error == 2.0);
  CHECK(m.mean_absolute_error == Approx(1.0).epsilon(tolerance(1e-15)));
  CHECK(m.mean_absolute_percentage == Approx(100.0 * (0.1 + 0.1 + 0.025) / 4).epsilon(1e-14));
  CHECK(m.rms_error == Approx(std::sqrt(1.5)).epsilon(tolerance(1e-15)));
  CHECK(m.r2 == Approx(1.0 - 6.0 / 500.0).epsilon(tolerance(1e-15)));
}

TEST_CASE("Percentages do not depend on the sign of the references", "[unit]") {
  const Metrics m = calc_metrics(std::vector{-10.0, 20.0}, std::vector{-9.0, 22.0});
  CHECK(m.mean_absolute_percentage == Approx(10.0).epsilon(tolerance(1e-14)));
}

TEST_CASE("A NaN prediction makes every metric NaN", "[unit]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Metrics m = calc_metrics(std::vector{1.0, 2.0, 3.0}, std::vector{1.0, nan, 3.0});
  CHECK(std::isnan(m.largest_error));
  CHECK(std::isnan(m.mean_absolute_error));
  CHECK(std::isnan(m.rms_error));
  CHECK(std::isnan(m.r2));
  CHECK_THROWS_AS(calc_metrics({}, {}), std::invalid_argument);
}

TEST_CASE("Normalization maps the bounds of each column to -1 and 1 and back", "[unit]") {
  const std::vector<double> rows = {1.0, -5.0, 3.0, 5.0, 2.0, 0.0};
  Normalizer normalizer(2);
  normalizer.include(rows);
  CHECK(normalizer.low() == std::vector{1.0, -5.0});
  CHECK(normalizer.high() == std::vector{3.0, 5.0});
  std::vector<double> z = rows;
  normalizer.normalize(z);
  CHECK(z == std::vector{-1.0, -1.0, 1.0, 1.0, 0.0, 0.0});
  normalizer.restore(z);
  CHECK(z == rows);
  CHECK(normalizer.find_constant() == 2);
}

TEST_CASE("Constant columns are found, and distances outside of the bounds are measured",
          "[unit]") {
  Normalizer normalizer(2);
  normalizer.include(std::vector{1.0, 4.0, 3.0, 4.0});
  CHECK(normalizer.find_constant() == 1);
  const Normalizer unit({0.0, 0.0}, {1.0, 2.0});
  CHECK(unit.calc_excess(std::vector{0.5, 1.0}) == 0.0);
  CHECK(unit.calc_excess(std::vector{0.5, 2.5}) == 0.25);
  CHECK(unit.calc_excess(std::vector{-3.0, 1.0}) == 3.0);
  CHECK(std::isnan(unit.calc_excess(std::vector{std::nan(""), 1.0})));
}

TEST_CASE("A split gives each part its fraction, at random, the same for the same seed", "[unit]") {
  const std::int64_t rows = GENERATE(10, 333, 2000);
  const Split split(rows, 0.7, 0.15, 5), again(rows, 0.7, 0.15, 5), other(rows, 0.7, 0.15, 6);
  std::vector<std::int64_t> counts(3, 0);
  std::int64_t differing = 0, first_half = 0;
  for (std::int64_t row = 0; row < rows; ++row) {
    const Part part = split.find_part(row);
    ++counts[static_cast<std::size_t>(part)];
    CHECK(part == again.find_part(row));
    differing += part != other.find_part(row) ? 1 : 0;
    first_half += part == Part::kTrain && row < rows / 2 ? 1 : 0;
  }
  CHECK(counts[0] == split.count(Part::kTrain));
  CHECK(counts[1] == split.count(Part::kValidate));
  CHECK(counts[2] == split.count(Part::kTest));
  CHECK(counts[0] == 7 * rows / 10);
  CHECK(differing > 0);
  if (rows > 1000) {
    // Hypergeometric: 700 ± 10 of the 1400 in the first half; six sigma.
    CHECK(std::abs(static_cast<double>(first_half) - 700.0) < 60.0);
  }
  CHECK_THROWS_AS(Split(3, 0.7, 0.15, 1), std::invalid_argument);
}

}  // namespace
}  // namespace strut
