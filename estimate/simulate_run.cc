#include "estimate/simulate_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error/input_error.h"
#include "base/text/range.h"
#include "estimate/driven_batch.h"
#include "estimate/hit_time.h"
#include "estimate/run_prepared.h"
#include "estimate/sampled_curve.h"
#include "estimate/sensor_error.h"
#include "model/channel/car_channels.h"
#include "model/error/model_error.h"
#include "model/sensor/sensors.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Interpolates the readings of the sensors of every channel of a car at the run's times.
void read_history(const LaneRun& simulated, const EffectSettings& effects,
                  const std::vector<double>& times, double hit_time, double step,
                  RunCurves& curves) {
  curves.channel.assign(CarChannel::kCount, std::vector<double>(times.size(), kNan));
  for (std::size_t c = 0; c < curves.channel.size(); ++c) {
    const std::vector<double> series = read_sensor(effects, list_car_channels()[c].name, step,
                                                   simulated.get_series(static_cast<int>(c)));
    for (std::size_t t = 0; t < times.size(); ++t) {
      const double at = (times[t] + hit_time) / step, index = std::floor(at);
      if (index < static_cast<double>(kCurveMargin)) continue;
      const auto i = static_cast<std::size_t>(index);
      if (i + 1 + kCurveMargin >= series.size()) continue;
      const auto get = [&](std::size_t sample) { return series[sample]; };
      curves.channel[c][t] = interpolate_curve(get, i, at - index, step).value;
    }
  }
}

/// The car of the run, with the duration that the readings need.
Case make_case(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
               const std::vector<double>& values, double hit_time) {
  Case c = set_unknowns({run.name, run.setup, {}, {}}, unknowns, values, 0).setup.car();
  constexpr double kMargin = 0.02;  // s
  const Range& allowed = find_parameter("duration").allowed;
  const double last = std::min(run.times.back() + hit_time + kMargin, c.maneuver.duration);
  c.maneuver.duration = std::clamp(last, allowed.low, allowed.high);
  return c;
}

RunCurves simulate_crossing(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                            const std::vector<double>& values) {
  RunCurves curves;
  const double hit_time = get_hit_time(unknowns, values, 0);
  const LinearizeOptions options;
  SamplePlan plan;
  plan.interval = 1.0 / options.rate;
  plan.snapshot = false;
  try {
    CasePreparer preparer;
    const Case c = make_case(run, unknowns, values, hit_time);
    const std::vector<PreparedCase> cases = {preparer.prepare(c)};
    const LaneRun simulated = run_prepared(cases, options.integrate, plan).front();
    if (simulated.status() != RunStatus::kDone) {
      curves.failure =
          fmt::format("{}: the simulation fails: {}", run.name, get_name(simulated.status()));
      return curves;
    }
    read_history(simulated, c.vehicle.effects, run.times, hit_time, plan.interval, curves);
  } catch (const ModelError& e) {
    curves.failure = fmt::format("{}: {}", run.name, e.what());
  }
  return curves;
}

RunCurves simulate_driven(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                          const std::vector<double>& values) {
  const DrivenTask task(run, 0, unknowns, values, {});
  if (!task.failure.empty()) throw InputError(task.failure);
  RunCurves curves;
  std::vector<int> channels(run.setup.info().channels.size());
  std::iota(channels.begin(), channels.end(), 0);
  simulate_tasks({task}, channels, 1, [&](std::size_t, const DrivenResult& result) {
    curves.failure = result.failure();
    if (!curves.failure.empty()) return;
    curves.channel.assign(channels.size(), std::vector<double>(run.times.size()));
    for (std::size_t c = 0; c < channels.size(); ++c) {
      for (std::size_t t = 0; t < run.times.size(); ++t) curves.channel[c][t] = result.read(t, c);
    }
  });
  return curves;
}

}  // namespace

RunCurves simulate_run(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                       const std::vector<double>& values) {
  RunCurves curves = run.setup.info().is_driven_by_inputs()
                         ? simulate_driven(run, unknowns, values)
                         : simulate_crossing(run, unknowns, values);
  if (!curves.failure.empty()) return curves;
  for (std::size_t c = 0; c < curves.channel.size(); ++c) {
    add_sensor_error(collect_sensor_error(unknowns, values, 0, static_cast<int>(c)), run.times,
                     curves.channel[c]);
  }
  return curves;
}

}  // namespace strut
