// A force of a strut that no effect of the catalogue explains, as a map over its deflection and
// velocity: what a person writes and a diagnosis fits. Equation: docs/theory.md, "Force maps".
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "model/effects/catalogue.h"
#include "model/force/force_map.h"

namespace strut {

/// F(d, v) = sum_ij coefficient_ij B_i(d) B_j(v) beside the damper, along its line and positive in
/// compression as its force; d counts from nominal trim (of a rig: from rest), v = dd/dt, positive
/// in compression. B: uniform cubic B-splines, `count` of them over a range, outside of which the
/// argument is held at the range's end. A count of 1: does not depend on that variable.
struct ForceMap {
  std::string place;                                      // "rear", "front_left", ...; "" on a rig
  double deflection_low = -0.05, deflection_high = 0.05;  // m
  int deflection_count = 1;
  double velocity_low = -1.0, velocity_high = 1.0;  // m/s
  int velocity_count = 1;
  std::vector<double> coefficients;  // N, at [i * velocity_count + j]
  bool operator==(const ForceMap&) const = default;
};

/// At most one a place; a corner's replaces its axle's there.
using ForceMaps = std::vector<ForceMap>;

/// What a count may be beside 1, and the largest coefficient [N].
inline constexpr int kFewestSplines = 4, kMostSplines = 64;
inline constexpr double kLargestMapForce = 1e6;

/// The names of the places where a map may act: axles and corners of a car, {""} on a rig.
const std::vector<std::string>& list_force_map_places(const ModelInfo& model);

/// Throws ModelError that says what is allowed: unknown places, two maps at one, empty ranges,
/// wrong counts, a wrong number of coefficients, those that are too large or not finite.
void validate(const ForceMaps& maps, const ModelInfo& model);

/// The map that acts at a corner or on a rig; null where there is none.
const ForceMap* find_force_map(const ForceMaps& maps, const std::string& place);

/// Arguments (Greville's) whose value as coefficients makes the spline the argument itself:
/// low + (i - 1) (high - low) / (count - 3); for a count of 1 the middle of the range.
std::vector<double> calc_map_abscissas(double low, double high, int count);

/// F(d, v) [N].
double calc_force(const ForceMap& map, double deflection, double velocity);

/// The map as force elements read it.
std::shared_ptr<const ForceMapTable> make_force_map_table(const ForceMap& map);

/// The tables of a car's corners; null where there is no map. Corners of one axle share theirs.
std::array<std::shared_ptr<const ForceMapTable>, 4> make_corner_force_maps(const ForceMaps& maps);

}  // namespace strut
