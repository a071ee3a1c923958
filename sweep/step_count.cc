#include "sweep/step_count.h"

#include "base/text/format_number.h"

namespace strut {

std::string find_step_count_fault(double duration, double step) {
  constexpr double kMaxSteps = 1e7;
  if (duration <= kMaxSteps * step) return "";
  return "a run of " + format_number(duration) + " s would take " +
         format_rounded(duration / step) + " steps; must be at least " +
         format_rounded(duration / kMaxSteps) + " s, for at most " + format_rounded(kMaxSteps) +
         " steps, or the run shorter";
}

}  // namespace strut
