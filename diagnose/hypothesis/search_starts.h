// Start values for the size of an effect, from the motion of the struts in the measured runs.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace strut {

/// The motion of the struts at one location, and their spring and damper rates.
struct StrutMotion {
  double compression = 0.0;      // m, maximum
  double deflection = 0.0;       // m, rms
  double velocity = 0.0;         // m/s, rms
  double fastest = 0.0;          // m/s, maximum of the absolute value
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

/// Range in which a shape parameter of an effect is what its name says, and determined.
struct SearchRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The range for this motion, without bounds where there is no rule. A knee far above all speeds
/// bends a law by loss / knee^2, whatever either is: both would run away together. A stop that is
/// met at rest is a spring that stiffens in compression, as compressed gas does.
SearchRange choose_search_range(const std::string& effect, const std::string& parameter,
                                const StrutMotion& motion);

}  // namespace strut
