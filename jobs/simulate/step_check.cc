#include "jobs/simulate/step_check.h"

#include <fmt/format.h>

#include "base/text/format_number.h"
#include "sweep/step_stability.h"

namespace strut {
namespace {

void check_step(const PreparedCase& c, const SimulateOptions& options, const char* name,
                double step) {
  const auto fault = find_step_fault(c, options.integrate, step);
  if (fault) throw make_step_error(options, name, step, fault->reason, fault->allowed);
}

}  // namespace

InputError make_step_error(const SimulateOptions& options, const char* name, double step,
                           const std::string& reason, const std::string& allowed) {
  const bool is_explicit = options.integrate.spin == SpinTreatment::kExplicit;
  return InputError(
      fmt::format("{} = {} s: unstable ({}) with --integrator {} --spin {} on {} in {}; {}{}", name,
                  format_number(step), reason, options.integrator_name(), options.spin_name(),
                  options.source.vehicle.string(), options.source.maneuver.string(), allowed,
                  is_explicit ? ", or --spin exponential" : ""));
}

void check_steps(const PreparedCase& c, const SimulateOptions& options) {
  if (options.integrator == Integrator::kCvode) return;
  const StepOptions& step = options.integrate.step;
  check_step(c, options, "--step", step.step);
  if (step.coarse_step > 0.0) check_step(c, options, "--coarse-step", step.coarse_step);
}

}  // namespace strut
