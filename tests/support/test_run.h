// Reading runs in tests.
#pragma once

#include "model/kernel/simulation.h"

namespace strut::test {

inline SamplePlan make_plan(double interval) {
  SamplePlan plan;
  plan.interval = interval;
  return plan;
}

}  // namespace strut::test
