#include "sweep/simulate_case.h"

#include <cmath>

#include "model/sensor/read_out.h"

namespace strut {

LaneResults simulate_case(const PreparedCase& c, const SolverOptions& integrate, double interval) {
  SamplePlan plan;
  plan.interval = interval;
  const ReadOut out(list_car_channels(), {&c.sensors});
  return simulate_readings(out, plan, [&](const SamplePlan& record) {
    return integrate.solver == Solver::kCvode
               ? run_cvode(c, integrate.reference, record)
               : list_kernels().front().run_scalar(c, integrate.options, record);
  });
}

bool has_snapshot(const LaneResults& results) { return std::isfinite(results.event_time[0]); }

std::vector<double> get_history(const LaneResults& results, std::size_t channels,
                                std::size_t channel) {
  std::vector<double> values(static_cast<std::size_t>(results.sample_count));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = results.history[i * channels + channel];
  }
  return values;
}

}  // namespace strut
