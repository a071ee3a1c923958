// Names of the choices that a sweep offers, in files and on the command line.
#pragma once

#include <string>
#include <vector>

#include "model/integrate/run_plan.h"

namespace strut {

/// The steppers in the order of Stepper, then Solver::kCvode.
inline const std::vector<std::string> kIntegrators = {"rk4", "abm4", "cvode"};
inline constexpr int kIntegratorAbm4 = 1, kIntegratorCvode = 2;              // in kIntegrators
inline const std::vector<std::string> kClosures = {"newton", "table"};       // Closure
inline const std::vector<std::string> kSpins = {"exponential", "explicit"};  // SpinTreatment

inline const std::vector<std::string> kSampleMethods = {"grid", "latin_hypercube",
                                                        "sobol"};  // SampleMethod
/// Events at which a snapshot is taken.
inline const std::vector<std::string> kInstants = {"rear_wheels_on_bump"};
/// Stratification by the mean relative loss over the axes.
inline const std::string kDegradation = "degradation";

inline const std::string& get_name(Stepper stepper) {
  return kIntegrators[static_cast<std::size_t>(stepper)];
}

inline constexpr double kMaxStep = 0.02;  // s; a wheel hop has a period of 80 ms

}  // namespace strut
