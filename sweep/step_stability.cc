#include "sweep/step_stability.h"

#include <fmt/format.h>

#include <cmath>

#include "model/kernel/stability.h"

namespace strut {
namespace {

/// Rounds down to two significant digits, so that the printed limit is itself allowed.
double round_down(double value) {
  if (!(value > 0.0)) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit) * unit;
}

}  // namespace

std::optional<StepFault> find_step_fault(const PreparedCase& c, IntegrateOptions integrate,
                                         double step) {
  integrate.step.step = step;
  const double amplification = calc_amplification(c, integrate);
  if (amplification <= kMaxAmplification) return std::nullopt;
  return StepFault{
      fmt::format("each step multiplies a disturbance by {:.3g}", amplification),
      fmt::format("must lie in (0, {:.2g}] s here", round_down(find_stable_step(c, integrate)))};
}

}  // namespace strut
