#include "diagnose/noise/smooth_road.h"

#include "base/error/input_error.h"
#include "estimate/linearize_options.h"

namespace strut {

LaneRun simulate_smooth_road(const Case& c, const SamplePlan& plan) {
  CasePreparer preparer;
  LaneRun run = run_prepared({preparer.prepare(c)}, make_fit_integration(), plan).front();
  if (run.status() != RunStatus::kDone) {
    throw InputError("the car cannot be simulated on a level road");
  }
  return run;
}

}  // namespace strut
