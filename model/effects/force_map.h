// A strut force that no effect of the catalogue explains, as a map over deflection and velocity.
// Force maps are written in model files and fitted by the diagnosis. Equation: docs/theory.md,
// "Force maps".
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "model/effects/catalogue.h"
#include "model/force/force_map.h"

namespace strut {

/// F(d, v) = sum_ij coefficient_ij B_i(d) B_j(v), parallel to the damper and, like its force,
/// positive in compression; deflection d from nominal trim (on a rig from rest) and v = dd/dt,
/// positive in compression. B: uniform cubic B-splines, `count` of them over a range; outside the
/// range the argument is clamped to its end. A count of 1: the force does not depend on that
/// variable.
struct ForceMap {
  std::string place;                                      // "rear", "front_left", ...; "" on a rig
  double deflection_low = -0.05, deflection_high = 0.05;  // m
  int deflection_count = 1;
  double velocity_low = -1.0, velocity_high = 1.0;  // m/s
  int velocity_count = 1;
  std::vector<double> coefficients;  // N, at [i * velocity_count + j]
  bool operator==(const ForceMap&) const = default;
};

/// At most one per place; the map of a corner replaces that of its axle.
using ForceMaps = std::vector<ForceMap>;

/// Range of a count other than 1, and maximum absolute value of a coefficient [N].
inline constexpr int kMinSplines = 4, kMaxSplines = 64;
inline constexpr double kMaxMapForce = 1e6;
constexpr bool is_spline_count(std::size_t count) {
  return count == 1 || (count >= kMinSplines && count <= kMaxSplines);
}

/// The names of the places where a map may act: axles and corners of a car, {""} on a rig.
const std::vector<std::string>& list_force_map_places(const ModelInfo& model);

/// Throws ModelError with the allowed values for unknown places, two maps at one place, empty
/// ranges, wrong counts, a wrong number of coefficients, and coefficients that are too large or not
/// finite.
void validate(const ForceMaps& maps, const ModelInfo& model);

/// The map that acts at a corner or on a rig; null where there is none.
const ForceMap* find_force_map(const ForceMaps& maps, const std::string& place);

/// Greville abscissas, which as coefficients reproduce the argument itself:
/// low + (i - 1) (high - low) / (count - 3); for a count of 1 the middle of the range.
std::vector<double> calc_map_abscissas(double low, double high, int count);

/// F(d, v) [N].
double calc_force(const ForceMap& map, double deflection, double velocity);

/// The map as a table for force elements.
std::shared_ptr<const ForceMapTable> make_force_map_table(const ForceMap& map);

/// The tables of a car's corners; null where there is no map. The corners of an axle share its
/// table.
std::array<std::shared_ptr<const ForceMapTable>, 4> make_corner_force_maps(const ForceMaps& maps);

}  // namespace strut
