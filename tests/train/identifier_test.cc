// Predictions of one case: derivatives, and the range trained on.
#include "train/model/identifier.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/test_model.h"
#include "train/model/interval.h"

namespace strut {
namespace {

TEST_CASE("An identifier's Jacobian is that of differences", "[property]") {
  const TrainedModel model = test::make_random_model(
      GENERATE(std::vector<int>{4, 9, 7, 2}, std::vector<int>{3, 2}, std::vector<int>{1, 5, 1}));
  const Identifier identifier(model);
  const std::size_t n = model.inputs.size(), m = model.targets.size();
  const std::vector<double> inputs = test::draw_inputs(model, 20);
  for (std::size_t row = 0; row < 20; ++row) {
    const std::vector<double> jacobian = identifier.calc_jacobian(inputs.data() + row * n);
    for (std::size_t i = 0; i < n; ++i) {
      const double width = model.input_map.high()[i] - model.input_map.low()[i];
      const double step = 1e-4 * width;
      std::vector<double> x(inputs.begin() + static_cast<std::ptrdiff_t>(row * n),
                            inputs.begin() + static_cast<std::ptrdiff_t>(row * n + n));
      std::vector<double> above(m), below(m);
      x[i] += step;
      identifier.identify(x.data(), above.data());
      x[i] -= 2.0 * step;
      identifier.identify(x.data(), below.data());
      for (std::size_t t = 0; t < m; ++t) {
        const double range = model.target_map.high()[t] - model.target_map.low()[t];
        const double difference = (above[t] - below[t]) / (2.0 * step);
        // Central differences: h^2 f'''/6, normalized step 2e-4, f''' of a few; rounding 1e-16/h.
        CHECK(std::abs(jacobian[t * n + i] - difference) < 1e-6 * range / width);
      }
    }
  }
}

TEST_CASE("Excess is a signed fraction of the range", "[unit]") {
  CHECK(calc_excess(0.5, 0.0, 2.0) == 0.0);
  CHECK(calc_excess(2.0, 0.0, 2.0) == 0.0);
  CHECK(calc_excess(3.0, 0.0, 2.0) == 0.5);
  CHECK(calc_excess(-1.0, 0.0, 2.0) == -0.5);
}

TEST_CASE("A parameter is out of range beyond its interval and a hundredth of the range",
          "[unit]") {
  const TrainedModel model = test::make_random_model();  // front_stiffness in [35500, 40000]
  CHECK(is_parameter_in_range(model, 0, 40044.0, 0.0));
  CHECK(!is_parameter_in_range(model, 0, 40046.0, 0.0));
  CHECK(is_parameter_in_range(model, 0, 40046.0, 2.0));
  CHECK(is_parameter_in_range(model, 0, 35456.0, 0.0));
  CHECK(!is_parameter_in_range(model, 0, 35454.0, 0.0));
  CHECK(!is_parameter_in_range(model, 0, std::nan(""), 1.0));
  CHECK(is_parameter_in_range(model, 0, 1e9, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace strut
