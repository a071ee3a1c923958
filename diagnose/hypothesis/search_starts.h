// Start values for the size of an effect, from the motion of the struts in the measured runs.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace strut {

/// The motion of the struts at one location, and their spring and damper rates.
struct StrutMotion {
  double compression = 0.0;      // m, maximum
  double deflection = 0.0;       // m, rms
  double velocity = 0.0;         // m/s, rms
  double stiffness = 0.0;        // N/m
  double damping = 0.0;          // N s/m
  double tire_deflection = 0.0;  // m, rms

  double frequency() const;     // rad/s
  double damper_force() const;  // N, rms
};

/// Start values by the names of the effect's parameters, one map per start; a parameter that is not
/// in the map has its default start value. One empty map for an effect without a rule of its own.
using SearchStarts = std::vector<std::map<std::string, double>>;
SearchStarts choose_search_starts(const std::string& effect, const StrutMotion& motion);

}  // namespace strut
