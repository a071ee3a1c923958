// Where the search for an effect's size begins, by how the struts move in the measured runs.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace strut {

/// The motion of the struts at a place, and their spring and damper rates.
struct StrutMotion {
  double compression = 0.0;      // m, the largest
  double deflection = 0.0;       // m, rms
  double velocity = 0.0;         // m/s, rms
  double stiffness = 0.0;        // N/m
  double damping = 0.0;          // N s/m
  double tire_deflection = 0.0;  // m, rms

  double frequency() const;     // rad/s
  double damper_force() const;  // N, rms
};

/// Sizes by the names of the effect's parameters, one map for each start; what a map leaves out
/// begins at its ordinary share. One empty map for an effect without a rule of its own.
using SearchStarts = std::vector<std::map<std::string, double>>;
SearchStarts choose_search_starts(const std::string& effect, const StrutMotion& motion);

}  // namespace strut
