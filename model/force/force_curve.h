// A measured curve of a damper's force over speed, or a tire's load over deflection, in place of a
// constant rate.
//
// A monotone cubic through the points (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980),
// extended by straight lines. The rate c of the damper or tire scales the curve:
// F = c / c_0 F_0(x), c_0 the curve's own rate, so that wear and fits act on all of it.
#pragma once

#include <memory>
#include <vector>

#include "model/scenario/input_signal.h"

namespace strut {

/// Points of a curve: a damper's speeds [m/s], positive in compression, or a tire's deflections
/// [m], and forces [N]; none: no curve.
struct ForceCurveSpec {
  std::vector<double> x, force;
  bool empty() const { return x.empty(); }
  bool operator==(const ForceCurveSpec&) const = default;
};

/// Throws ModelError unless speeds increase, forces do not decrease, (0, 0) is among the points,
/// and both signs of speed have points.
void validate_damper_curve(const ForceCurveSpec& spec);

/// Throws ModelError unless there are two points or more, the first is (0, 0), and deflections and
/// loads increase.
void validate_tire_curve(const ForceCurveSpec& spec);

/// The rate of the straight line through the origin closest to the points [N s/m or N/m].
double calc_curve_rate(const ForceCurveSpec& spec);

/// An upper bound of the curve's slope over its own rate: a monotone cubic is at most 1.5 times as
/// steep as the line between its ends; 1 for no curve.
double calc_peak_slope_ratio(const ForceCurveSpec& spec);

/// Rates in N s/m of a damper, N/m of a tire.
struct ForceCurve {
  InputSignal force;             // N over x
  double rate;                   // c_0
  double low_slope, high_slope;  // of the lines beyond the ends
  double zero_slope;             // at x = 0
};

/// Null for no curve; requires a valid one.
std::shared_ptr<const ForceCurve> make_force_curve(const ForceCurveSpec& spec);

/// F_0(x) / (c_0 x): the factor of the rate at x.
template <class T>
T calc_rate_factor(const ForceCurve& curve, const T& x) {
  const T low(curve.force.begin), high(curve.force.end);
  const T force = calc_signal(curve.force, x).value + T(curve.low_slope) * min(x - low, T(0.0)) +
                  T(curve.high_slope) * max(x - high, T(0.0));
  constexpr double kRest = 1e-9;  // m/s or m; the curve is a straight line within it
  const auto rests = abs(x) < T(kRest);
  const T rate = select(rests, T(curve.zero_slope), force / select(rests, T(1.0), x));
  return rate * T(1.0 / curve.rate);
}

}  // namespace strut
