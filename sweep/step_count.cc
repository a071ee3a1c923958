#include "sweep/step_count.h"

#include <fmt/format.h>

#include "base/text/format_number.h"

namespace strut {

std::string find_step_count_fault(double duration, double step) {
  constexpr double kMaxSteps = 1e7;
  if (duration <= kMaxSteps * step) return "";
  return fmt::format(
      "a run of {} s would take {} steps; use steps of at least {} s, so that there are at most "
      "{}, "
      "or a shorter run",
      format_number(duration), format_rounded(duration / step),
      format_rounded(duration / kMaxSteps), format_rounded(kMaxSteps));
}

}  // namespace strut
