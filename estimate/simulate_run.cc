#include "estimate/simulate_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "base/error/input_error.h"
#include "base/text/range.h"
#include "estimate/driven_batch.h"
#include "estimate/hit_time.h"
#include "estimate/run_prepared.h"
#include "estimate/sampled_curve.h"
#include "estimate/sensor_error.h"
#include "model/channel/car_channels.h"
#include "model/effects/catalogue.h"
#include "model/error/model_error.h"
#include "model/sensor/sensors.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Interpolates the readings of the sensors of `channels` of a car at the run's times.
void read_history(const LaneRun& simulated, const EffectSettings& effects,
                  const std::vector<double>& times, double hit_time, double step,
                  const std::vector<int>& channels, RunCurves& curves) {
  curves.channel.resize(CarChannel::kCount);
  for (const int channel : channels) {
    const auto c = static_cast<std::size_t>(channel);
    curves.channel[c].assign(times.size(), kNan);
    const std::vector<double> series =
        read_sensor(effects, list_car_channels()[c], step, simulated.get_series(channel));
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

using Points = std::vector<std::vector<double>>;

std::vector<RunCurves> simulate_crossings(const MeasuredRun& run,
                                          const std::vector<Unknown>& unknowns,
                                          const Points& points, const std::vector<int>& channels) {
  const LinearizeOptions options;
  SamplePlan plan;
  plan.interval = 1.0 / options.rate;
  plan.snapshot = false;
  plan.recorded = channels;
  std::vector<RunCurves> curves(points.size());
  std::vector<PreparedCase> cases;
  std::vector<std::size_t> prepared;  // points of the cases
  std::vector<EffectSettings> effects;
  CasePreparer preparer;
  for (std::size_t p = 0; p < points.size(); ++p) {
    try {
      const Case c = make_case(run, unknowns, points[p], get_hit_time(unknowns, points[p], 0));
      cases.push_back(preparer.prepare(c));
      prepared.push_back(p);
      effects.push_back(c.vehicle.effects);
    } catch (const ModelError& e) {
      curves[p].failure = fmt::format("{}: {}", run.name, e.what());
    }
  }
  std::vector<LaneRun> simulated;
  try {
    simulated = run_prepared(cases, options.integrate, plan);
  } catch (const ModelError& e) {
    for (const std::size_t p : prepared)
      curves[p].failure = fmt::format("{}: {}", run.name, e.what());
    return curves;
  }
  for (std::size_t i = 0; i < cases.size(); ++i) {
    RunCurves& at = curves[prepared[i]];
    if (simulated[i].status() != RunStatus::kDone) {
      at.failure =
          fmt::format("{}: the simulation fails: {}", run.name, get_name(simulated[i].status()));
      continue;
    }
    read_history(simulated[i], effects[i], run.times,
                 get_hit_time(unknowns, points[prepared[i]], 0), plan.interval, channels, at);
  }
  return curves;
}

std::vector<RunCurves> simulate_driven(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                                       const Points& points, const std::vector<int>& channels) {
  std::vector<DrivenTask> tasks;
  for (const std::vector<double>& values : points) {
    tasks.emplace_back(run, 0, unknowns, values, LinearizeOptions{});
    if (!tasks.back().failure.empty()) throw InputError(tasks.back().failure);
  }
  std::vector<RunCurves> curves(points.size());
  simulate_tasks(tasks, channels, 1, [&](std::size_t p, const DrivenResult& result) {
    curves[p].failure = result.failure();
    if (!curves[p].failure.empty()) return;
    curves[p].channel.resize(run.setup.info().channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
      std::vector<double>& channel = curves[p].channel[static_cast<std::size_t>(channels[c])];
      channel.resize(run.times.size());
      for (std::size_t t = 0; t < run.times.size(); ++t) channel[t] = result.read(t, c);
    }
  });
  return curves;
}

std::vector<RunCurves> simulate_channels(const MeasuredRun& run,
                                         const std::vector<Unknown>& unknowns, const Points& points,
                                         const std::vector<int>& channels) {
  std::vector<RunCurves> curves = run.setup.info().is_driven_by_inputs()
                                      ? simulate_driven(run, unknowns, points, channels)
                                      : simulate_crossings(run, unknowns, points, channels);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!curves[p].failure.empty()) continue;
    for (const int c : channels) {
      add_sensor_error(collect_sensor_error(unknowns, points[p], 0, c), run.times,
                       curves[p].channel[static_cast<std::size_t>(c)]);
    }
  }
  return curves;
}

}  // namespace

RunCurves simulate_run(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                       const std::vector<double>& values) {
  std::vector<int> all(run.setup.info().channels.size());
  std::iota(all.begin(), all.end(), 0);
  return std::move(simulate_channels(run, unknowns, {values}, all).front());
}

RunCurves simulate_motion(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                          const std::vector<double>& values) {
  MeasuredRun ideal = set_unknowns(run, unknowns, values);
  std::erase_if(ideal.setup.effects(), is_sensor_setting);
  return simulate_run(ideal, {}, {});
}

std::vector<RunCurves> simulate_points(const MeasuredRun& run, const std::vector<Unknown>& unknowns,
                                       const std::vector<std::vector<double>>& points) {
  std::set<int> compared;
  for (const MeasuredChannel& c : run.channels) compared.insert(c.channel);
  return simulate_channels(run, unknowns, points, {compared.begin(), compared.end()});
}

}  // namespace strut
