// Steps and samples of runs in tests.
#pragma once

#include "model/kernel/simulation.h"

namespace strut::test {

inline SamplePlan make_plan(double interval) {
  SamplePlan plan;
  plan.interval = interval;
  return plan;
}

inline SamplePlan make_plan(double duration, double interval) {
  SamplePlan plan = make_plan(interval);
  plan.duration = duration;
  return plan;
}

inline StepOptions make_steps(double step, Stepper stepper = Stepper::kRk4) {
  StepOptions options;
  options.step = step;
  options.stepper = stepper;
  return options;
}

}  // namespace strut::test
