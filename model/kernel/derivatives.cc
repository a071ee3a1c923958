#include "model/kernel/derivatives.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/parallel/instruction_sets.h"
#include "model/kernel/run_derivatives.h"

STRUT_DECLARE_KERNELS(strut::DerivativeKernel, strut_derivatives_)

namespace strut {

bool have_equal_roads(const PreparedCase& a, const PreparedCase& b) {
  return a.mechanism->surface == b.mechanism->surface && a.rough == b.rough;
}

namespace {

bool have_equal_maps(const CornerForceMaps& a, const CornerForceMaps& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
    return x == y || (x != nullptr && y != nullptr && *x == *y);
  });
}

/// Whether no effect is on in one of two cars alone: neither an element of a strut nor a number of
/// one that its equations branch on.
bool have_equal_parts(const PreparedCase& a, const PreparedCase& b) {
  const VehicleLayout &x = a.vehicle.layout, &y = b.vehicle.layout;
  const auto have_equal_zeros = [](const auto& p, const auto& q) {
    constexpr std::size_t kFields = sizeof(p) / sizeof(double);
    std::array<double, kFields> u, v;
    std::memcpy(u.data(), &p, sizeof(p));
    std::memcpy(v.data(), &q, sizeof(q));
    return std::equal(u.begin(), u.end(), v.begin(),
                      [](double s, double t) { return (s == 0.0) == (t == 0.0); });
  };
  return x.strut_effects == y.strut_effects && x.has_anti_roll_bar == y.has_anti_roll_bar &&
         x.progressive_tire == y.progressive_tire && x.has_runout == y.has_runout &&
         x.has_lift == y.has_lift &&
         have_equal_zeros(a.vehicle.numbers.effects, b.vehicle.numbers.effects);
}

/// Whether a road has no kink.
bool is_smooth(const PreparedCase& c) { return c.mechanism->surface.segments.size() <= 1; }

bool differ_smoothly(const PreparedCase& a, const PreparedCase& b) {
  const VehicleSpec &x = a.mechanism->vehicle, &y = b.mechanism->vehicle;
  return a.vehicle.pacejka == b.vehicle.pacejka && is_symmetric(a) == is_symmetric(b) &&
         ((is_smooth(a) && is_smooth(b)) || have_equal_roads(a, b)) &&
         x.tire.curve == y.tire.curve &&
         x.suspension[kFront].damper_curve == y.suspension[kFront].damper_curve &&
         x.suspension[kRear].damper_curve == y.suspension[kRear].damper_curve &&
         have_equal_maps(a.force_maps, b.force_maps) && have_equal_parts(a, b) &&
         a.sensors == b.sensors;
}

}  // namespace

const std::vector<DerivativeKernel>& list_derivative_kernels() {
  static const std::vector<DerivativeKernel> kernels =
      STRUT_LIST_KERNELS(DerivativeKernel, strut_derivatives_);
  return kernels;
}

bool is_differentiable(const PreparedCase& at, const Neighbors& neighbors) {
  return neighbors.above == nullptr ||
         (differ_smoothly(at, *neighbors.above) && differ_smoothly(at, *neighbors.below));
}

void check_differentiated(const DifferentiatedCase* cases, int count,
                          const IntegrateOptions& options) {
  if (options.closure != Closure::kTable) {
    throw ModelError("derivatives: runs are differentiated with tables as closure");
  }
  for (int i = 0; i < count; ++i) {
    for (const Neighbors& along : cases[i].along) {
      if (!is_differentiable(*cases[i].at, along)) {
        throw ModelError(
            "derivatives: a parameter does not act smoothly on its case (is_differentiable)");
      }
      for (const PreparedCase* c : {cases[i].at, along.above, along.below}) {
        if (c == nullptr || may_share_lanes(*cases[0].at, *c, options)) continue;
        throw ModelError("lanes: these cases may not share a batch (see may_share_lanes)");
      }
    }
  }
}

}  // namespace strut
