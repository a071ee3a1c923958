#include "sweep/simulate_case.h"

#include "model/sensor/read_out.h"

namespace strut {

LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate, double interval) {
  SamplePlan plan;
  plan.interval = interval;
  return simulate_case(c, integrate, plan);
}

LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate,
                          const SamplePlan& plan, const Kernel& kernel) {
  const ReadOut out(list_car_channels(), {&c.sensors});
  return simulate_readings(out, plan, [&](const SamplePlan& record) {
    return integrate.solver == Solver::kCvode ? run_cvode(c, integrate.reference, record)
                                              : kernel.run_scalar(c, integrate.options, record);
  });
}

}  // namespace strut
