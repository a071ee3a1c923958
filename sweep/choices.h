// The words of every choice of a sweep, in files and on the command line.
#pragma once

#include <string>
#include <vector>

#include "model/integrate/run_plan.h"

namespace strut {

/// By Stepper, then Solver::kCvode.
inline const std::vector<std::string> kIntegrators = {"rk4", "abm4", "cvode"};
inline const std::vector<std::string> kClosures = {"newton", "table"};       // Closure
inline const std::vector<std::string> kSpins = {"exponential", "explicit"};  // SpinTreatment
inline constexpr int kIntegratorAbm4 = 1, kIntegratorCvode = 2;              // of kIntegrators

inline const std::vector<std::string> kSampleMethods = {"grid", "latin_hypercube",
                                                        "sobol"};           // SampleMethod
inline const std::vector<std::string> kInstants = {"rear_wheels_on_bump"};  // of a snapshot
/// Layers by the mean relative loss over the axes.
inline const std::string kDegradation = "degradation";

inline const std::string& get_name(Stepper stepper) {
  return kIntegrators[static_cast<std::size_t>(stepper)];
}

inline constexpr double kMaxStep = 0.02;  // s, a wheel hop has 80 ms

}  // namespace strut
