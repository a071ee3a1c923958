#include "jobs/case/step_check.h"

#include <cmath>
#include <cstdio>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "model/kernel/stability.h"

namespace strut {
namespace {

/// To two digits, so that what is printed as allowed is.
double round_down(double value) {
  if (!(value > 0.0)) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit) * unit;
}

void check_step(const PreparedCase& c, const SimulateOptions& options, const char* name,
                double step) {
  const auto fault = find_step_fault(c, options.integrate, step);
  if (fault) throw make_step_error(options, name, step, fault->how, fault->allowed);
}

}  // namespace

std::optional<StepFault> find_step_fault(const PreparedCase& c, IntegrateOptions integrate,
                                         double step) {
  integrate.step.step = step;
  const double amplification = calc_amplification(c, integrate);
  if (amplification <= kMaxAmplification) return std::nullopt;
  char how[64], allowed[64];
  std::snprintf(how, sizeof how, "each step multiplies a disturbance by %.3g", amplification);
  std::snprintf(allowed, sizeof allowed, "must lie in (0, %.2g] s here",
                round_down(find_stable_step(c, integrate)));
  return StepFault{how, allowed};
}

InputError make_step_error(const SimulateOptions& options, const char* name, double step,
                           const std::string& how, const std::string& allowed) {
  const bool is_explicit = options.integrate.spin == SpinTreatment::kExplicit;
  return InputError(std::string(name) + " = " + format_number(step) + " s: unstable (" + how +
                    ") with --integrator " + options.integrator_name() + " --spin " +
                    options.spin_name() + " on " + options.source.vehicle.string() + " in " +
                    options.source.maneuver.string() + "; " + allowed +
                    (is_explicit ? ", or --spin exponential" : ""));
}

void check_steps(const PreparedCase& c, const SimulateOptions& options) {
  if (options.integrator == kIntegratorCvode) return;
  const StepOptions& step = options.integrate.step;
  check_step(c, options, "--step", step.step);
  if (step.coarse_step > 0.0) check_step(c, options, "--coarse-step", step.coarse_step);
}

}  // namespace strut
