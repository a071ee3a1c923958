// The dependence of a force map on deflection and velocity, in numbers and words.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/visited_states.h"
#include "model/effects/force_map.h"

namespace strut {

struct MapCurve {
  std::vector<double> x, force;  // m or m/s, ascending over the visited range; N
};

/// F(d, v) ~ mean + a(v) + b(d) by least squares over the visited states, and the fractions of the
/// variance there: cov(a, F) / var F, cov(b, F) / var F, and the rest.
struct MapDependence {
  double of_velocity = 0.0, of_deflection = 0.0, of_both = 0.0;  // sum to 1; 0 without a force
  double spread = 0.0;                                           // standard deviation of F [N]
  MapCurve over_velocity, over_deflection;                       // a and b
  /// "velocity (91 %), saturates above 0.2 m/s, alike in both directions"
  std::string words;
};

/// Measures the dependence of `map` over the visited `states`.
MapDependence measure_dependence(const ForceMap& map, const VisitedStates& states);

enum class MapVariable { kVelocity, kDeflection };

/// The shape of a curve, without a constant and a straight line, which preload, stiffness and
/// damping explain: whether it saturates or hardens, above which value, in one direction or both,
/// or has a step or a kink at rest. Empty for a straight line.
std::string describe_curve(const MapCurve& curve, MapVariable variable);

}  // namespace strut
