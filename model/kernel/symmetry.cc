#include <algorithm>
#include <cmath>

#include "model/kernel/simulation.h"

namespace strut {
namespace {

/// Relative difference that rounding makes of equal numbers left and right.
constexpr double kRounding = 1e-12;

bool are_equal(double a, double b) {
  return a == b || std::fabs(a - b) <= kRounding * std::max(std::fabs(a), std::fabs(b));
}

/// `X`: a struct whose fields are all double.
template <class X>
bool are_equal(const X& a, const X& b) {
  static_assert(std::is_trivially_copyable_v<X> && sizeof(X) % sizeof(double) == 0);
  std::array<double, sizeof(X) / sizeof(double)> x, y;
  __builtin_memcpy(x.data(), &a, sizeof(X));
  __builtin_memcpy(y.data(), &b, sizeof(X));
  return std::equal(x.begin(), x.end(), y.begin(),
                    [](double u, double v) { return are_equal(u, v); });
}

bool is_symmetric(const RigidBody<double>& chassis) {
  const Sym3<double>& j = chassis.inertia;
  const double size = j.xx + j.yy + j.zz;  // kg m^2; a length of the car is of order 1 m
  return std::fabs(chassis.center.y) <= kRounding && std::fabs(j.xy) <= kRounding * size &&
         std::fabs(j.yz) <= kRounding * size;
}

bool have_equal_maps(const CornerForceMaps& maps, int left) {
  const ForceMapTable* a = maps[static_cast<std::size_t>(left)].get();
  const ForceMapTable* b = maps[static_cast<std::size_t>(left) + 1].get();
  if (a == nullptr || b == nullptr) return a == b;
  return are_equal(a->deflection, b->deflection) && are_equal(a->velocity, b->velocity) &&
         a->stride == b->stride && a->coefficients == b->coefficients;
}

/// Whether the corners of an axle are mirror images. The linkages are by construction (spec.h).
bool is_symmetric_axle(const PreparedCase& c, int left) {
  const int right = left + 1;
  const VehicleParameters<double>& numbers = c.vehicle.numbers;
  const VehicleLayout& layout = c.vehicle.layout;
  const auto have_equal_lengths = [&](int line) {
    return are_equal(numbers.nominal_length[left * kLines + line],
                     numbers.nominal_length[right * kLines + line]);
  };
  return layout.on_bump[left] == layout.on_bump[right] &&
         layout.strut_effects[left] == layout.strut_effects[right] &&
         are_equal(numbers.spring[left], numbers.spring[right]) &&
         are_equal(numbers.damper[left], numbers.damper[right]) &&
         are_equal(numbers.effects[left], numbers.effects[right]) &&
         are_equal(numbers.drive_torque[left], numbers.drive_torque[right]) &&
         are_equal(numbers.runout[left], numbers.runout[right]) &&
         have_equal_lengths(kSpringLine) && have_equal_lengths(kDamperLine) &&
         have_equal_maps(c.force_maps, left);
}

/// Whether mirror_left_side leaves a state as it is, and nothing moves sideways.
bool is_symmetric(const State<double>& x) {
  State<double> mirrored{};
  for (const int component : SymmetricStateIndex::kComponent) {
    mirrored[static_cast<std::size_t>(component)] = x[static_cast<std::size_t>(component)];
  }
  mirror_left_side(mirrored.data());
  return std::equal(x.begin(), x.end(), mirrored.begin(), [](double a, double b) {
    return are_equal(a, b) || std::fabs(a - b) <= kRounding;
  });
}

}  // namespace

bool is_symmetric(const PreparedCase& c) {
  const Mechanism& mechanism = *c.mechanism;
  return mechanism.vehicle.rack_position == 0.0 && is_symmetric(c.vehicle.numbers.chassis) &&
         is_symmetric_axle(c, kFrontLeft) && is_symmetric_axle(c, kRearLeft) &&
         c.rough[0] == c.rough[1] && is_symmetric(c.start);
}

}  // namespace strut
