#include "python/core/rig_run.h"

#include <fmt/format.h>

#include <string>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "model/longest_step.h"
#include "model/rig/rig_system.h"
#include "model/sensor/read_out.h"
#include "sweep/step_count.h"

namespace strut {

LaneResults simulate_rig_run(const RigSpec& rig, const RigManeuver& maneuver,
                             const IntegrationWords& words, double interval) {
  const SolverOptions options = read_single_run(words, calc_longest_step(rig));
  if (options.solver == Solver::kCvode || words.closure || words.spin || words.coarse_step) {
    throw InputError(
        "integrator = cvode, closure, spin, coarse_step: for cars only; allowed for a rig: rk4, "
        "abm4, "
        "step, events");
  }
  const double step = options.options.step.step;
  const std::string fault = find_step_count_fault(maneuver.duration, step);
  if (!fault.empty()) throw InputError(fmt::format("step = {} s: {}", format_number(step), fault));
  SamplePlan plan;
  plan.duration = maneuver.duration;
  plan.interval = interval;
  plan.snapshot = false;
  const ReadOut out(get_rig_info(rig.kind).channels, {&rig.effects});
  return simulate_readings(out, plan, [&](const SamplePlan& record) {
    return simulate_rig(rig, maneuver.inputs, options.options.step, record);
  });
}

}  // namespace strut
