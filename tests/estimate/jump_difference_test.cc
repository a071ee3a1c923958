// Differences of readings that jump where a contact event passes them.
#include "estimate/jump_difference.h"

#include <catch2/catch.hpp>

#include "tests/support/tolerance.h"

namespace strut {
namespace {

TEST_CASE("A jump on one side of a difference does not count", "[unit]") {
  const auto calc = [](double (*f)(double)) {
    constexpr double kAt = 0.3, kStep = 1e-3;
    return calc_jump_free_difference(f(kAt) - f(kAt - kStep), f(kAt + kStep) - f(kAt)) /
           (2.0 * kStep);
  };
  CHECK(calc([](double x) { return x * x; }) == Approx(0.6).epsilon(test::tolerance(1e-9)));
  CHECK(calc([](double x) { return x + (x > 0.3 ? 5.0 : 0.0); }) ==
        Approx(1.0).epsilon(test::tolerance(1e-9)));
  CHECK(calc([](double x) { return x + (x < 0.2995 ? 5.0 : 0.0); }) ==
        Approx(1.0).epsilon(test::tolerance(1e-9)));
  // Rounding error stays what it is.
  CHECK(calc_jump_free_difference(-2e-7, 1e-7) == Approx(-1e-7));
}

}  // namespace
}  // namespace strut
