// The words of every choice of a sweep, in files and on the command line.
#pragma once

#include <string>
#include <vector>

namespace strut {

inline const std::vector<std::string> kIntegrators = {"rk4", "abm4", "cvode"};
inline const std::vector<std::string> kClosures = {"newton", "table"};       // Closure
inline const std::vector<std::string> kSpins = {"exponential", "explicit"};  // SpinTreatment
inline constexpr int kIntegratorAbm4 = 1, kIntegratorCvode = 2;              // of kIntegrators

inline const std::vector<std::string> kSampleMethods = {"grid", "latin_hypercube",
                                                        "sobol"};           // SampleMethod
inline const std::vector<std::string> kInstants = {"rear_wheels_on_bump"};  // of a snapshot
/// Layers by the mean relative loss over the axes.
inline const std::string kDegradation = "degradation";

inline constexpr double kMaxStep = 0.02;  // s, a wheel hop has 80 ms

}  // namespace strut
