// The words of the ways to integrate, on the command line and in files.
#pragma once

#include <string>
#include <vector>

namespace strut {

inline const std::vector<std::string> kIntegrators = {"rk4", "abm4", "cvode"};
inline const std::vector<std::string> kClosures = {"newton", "table"};       // Closure
inline const std::vector<std::string> kSpins = {"exponential", "explicit"};  // SpinTreatment
inline constexpr int kAbm4 = 1, kCvode = 2;                                  // of kIntegrators

inline constexpr double kMaxStep = 0.02;  // s, a wheel hop has 80 ms

}  // namespace strut
