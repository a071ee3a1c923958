// Tolerances of the tests, all scaled together.
#pragma once

#include <cstdlib>

namespace strut::test {

/// Every tolerance is multiplied by STRUT_TOLERANCE_SCALE; at 0 all comparisons fail and print the
/// real residuals.
inline double tolerance(double value) {
  const char* text = std::getenv("STRUT_TOLERANCE_SCALE");
  return text != nullptr ? std::atof(text) * value : value;
}

}  // namespace strut::test
