#include "model/force/tire_contact.h"

#include <fmt/format.h>

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

#include "model/error/model_error.h"

namespace strut {
namespace {

/// k (x + q x^2) = load.
double solve_progressive(double linear, double progression) {
  if (progression == 0.0) return linear;
  return 2.0 * linear / (1.0 + std::sqrt(1.0 + 4.0 * progression * linear));
}

}  // namespace

double calc_static_deflection(const TireVertical<double>& tire, const ForceCurve* curve,
                              double load) {
  const double linear = load / tire.stiffness;
  if (curve == nullptr || load == 0.0) return solve_progressive(linear, tire.progression);
  const auto calc_excess = [&](double deflection) {
    return tire.stiffness * deflection + calc_progressive_load(tire, deflection) +
           calc_curved_load(tire, *curve, deflection) - load;
  };
  constexpr int kDoublings = 20;
  double high = linear;
  for (int i = 0; i < kDoublings && !(calc_excess(high) >= 0.0); ++i) high *= 2.0;
  if (!(calc_excess(high) >= 0.0)) {
    throw ModelError(fmt::format("tire curve: no deflection carries the load of {:g} N", load));
  }
  std::uintmax_t steps = 100;
  const auto [a, b] = boost::math::tools::bisect(
      calc_excess, 0.0, high, boost::math::tools::eps_tolerance<double>(50), steps);
  return 0.5 * (a + b);
}

}  // namespace strut
