// A measured damper curve, force over speed, in place of a constant rate.
//
// A monotone cubic through the points (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980),
// extended by straight lines. A damper's rate c scales the curve: F = c / c_0 F_0(v), c_0 the
// curve's own rate, so that wear and fade act on all of it.
#pragma once

#include <memory>
#include <vector>

#include "model/scenario/input_signal.h"

namespace strut {

/// Points of a curve: speeds [m/s], positive in compression, and forces [N]; none: no curve.
struct DamperCurveSpec {
  std::vector<double> speed, force;
  bool empty() const { return speed.empty(); }
  bool operator==(const DamperCurveSpec&) const = default;
};

/// Throws ModelError unless speeds increase, forces do not decrease, (0, 0) is among the points,
/// and both signs of speed have points.
void validate(const DamperCurveSpec& spec);

/// The rate of the straight line through the origin closest to the points [N s/m].
double calc_curve_rate(const DamperCurveSpec& spec);

struct DamperCurve {
  InputSignal force;             // N over the speed [m/s]
  double rate;                   // c_0, N s/m
  double low_slope, high_slope;  // N s/m, of the lines beyond the ends
  double rest_slope;             // N s/m, at rest
};

/// Null for no curve.
std::shared_ptr<const DamperCurve> make_damper_curve(const DamperCurveSpec& spec);

/// F_0(v) / (c_0 v): the factor of a damper's rate at speed v [m/s].
template <class T>
T calc_rate_factor(const DamperCurve& curve, const T& speed) {
  const T low(curve.force.begin), high(curve.force.end);
  const T force = calc_signal(curve.force, speed).value +
                  T(curve.low_slope) * min(speed - low, T(0.0)) +
                  T(curve.high_slope) * max(speed - high, T(0.0));
  constexpr double kRest = 1e-9;  // m/s; the curve is a straight line within it
  const auto rests = abs(speed) < T(kRest);
  const T rate = select(rests, T(curve.rest_slope), force / select(rests, T(1.0), speed));
  return rate * T(1.0 / curve.rate);
}

}  // namespace strut
