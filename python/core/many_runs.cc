#include "python/core/many_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "model/effects/catalogue.h"
#include "model/longest_step.h"
#include "model_files/parameter.h"
#include "sweep/read_grid.h"

namespace strut {
namespace {

/// Cases of one item of work: a few items for each thread, of whole batches.
std::size_t choose_item(const ManyRequest& request, std::size_t batch) {
  constexpr std::size_t kLargest = 128, kItemsPerThread = 4;
  const std::size_t items = kItemsPerThread * static_cast<std::size_t>(request.threads);
  const std::size_t batches = (request.count / items + batch - 1) / batch;
  return std::clamp(batches * batch, batch, std::max(batch, kLargest));
}

ManyResults make_results(const ManyRequest& request, double duration) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  SamplePlan samples = request.plan.samples;
  samples.duration = duration;
  ManyResults results;
  results.sample_count = static_cast<std::size_t>(count_samples(samples));
  results.status.assign(request.count, 0);
  results.failure_time.assign(request.count, kNone);
  results.event_time.assign(request.count, kNone);
  results.reason.resize(request.count);
  const std::size_t series = request.channels.size() * request.count;
  if (samples.snapshot) results.snapshot.assign(series, kNone);
  results.history.assign(series * results.sample_count, kNone);
  return results;
}

void fail(ManyResults& results, std::size_t number, RunStatus status, double time,
          const std::string& reason) {
  results.status[number] = static_cast<std::int32_t>(status);
  results.failure_time[number] = time;
  results.reason[number] = reason;
}

void record(const ManyRequest& request, std::size_t number, const LaneResults& run, int lane,
            ManyResults& results) {
  const RunStatus status = run.get_status(lane);
  if (status != RunStatus::kDone) {
    fail(results, number, status, run.get_failure_time(lane),
         kRunStatuses[static_cast<std::size_t>(status)].reason);
    return;
  }
  results.event_time[number] = run.get_event_time(lane);
  if (request.plan.samples.snapshot && !run.has_snapshot(lane)) {
    const auto& info = kRunStatuses[static_cast<std::size_t>(RunStatus::kNoEvent)];
    fail(results, number, info.status, run.get_failure_time(lane), info.reason);
  }
  for (std::size_t c = 0; c < request.channels.size(); ++c) {
    const std::size_t row = c * request.count + number;
    if (request.plan.samples.snapshot) {
      results.snapshot[row] = run.get_snapshot(request.channels[c], lane);
    }
    for (int i = 0; i < run.sample_count; ++i) {
      // Where a sensor is on, all channels are recorded.
      const int column = run.recorded.empty() ? request.channels[c] : static_cast<int>(c);
      results.history[row * results.sample_count + static_cast<std::size_t>(i)] =
          run.get_sample(i, column, lane);
    }
  }
}

void refuse_shared_quantities(const ManyRequest& request) {
  for (const ParameterInfo* first : request.parameters) {
    for (const ParameterInfo* second : request.parameters) {
      if (first == second || !share_quantity(*first, *second, request.base)) continue;
      throw InputError(fmt::format("{}: sets the same quantity as {}; allowed: one of the two",
                                   second->name, first->name));
    }
  }
}

bool has_sensors(const EffectSettings& effects) {
  return std::any_of(effects.begin(), effects.end(), is_sensor_setting);
}

}  // namespace

Case ManyRequest::make_case(std::size_t number) const {
  Case c = base;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    parameters[p]->set(c, get_value(number, p));
  }
  return c;
}

ManyNeeds find_needs(const ManyRequest& request) {
  refuse_shared_quantities(request);
  const Case& base = request.base;
  ManyNeeds needs{calc_longest_step(base), 0.0, std::numeric_limits<double>::infinity(),
                  has_sensors(base.vehicle.effects)};
  const bool moves_effects = !base.vehicle.effects.empty() ||
                             std::any_of(request.parameters.begin(), request.parameters.end(),
                                         [](const ParameterInfo* p) { return p->is_effect; });
  for (std::size_t i = 0; i < request.count; ++i) {
    double duration = base.maneuver.duration, speed = base.maneuver.speed;
    for (std::size_t p = 0; p < request.parameters.size(); ++p) {
      const ParameterInfo& parameter = *request.parameters[p];
      const double value = request.get_value(i, p);
      try {
        check_value(parameter, value);
      } catch (const InputError& e) {
        throw InputError(fmt::format("case {}: {}", i, e.what()));
      }
      if (parameter.name == "duration") duration = value;
      if (parameter.name == "speed") speed = value;
    }
    needs.duration = std::max(needs.duration, duration);
    needs.lowest_speed = std::min(needs.lowest_speed, speed);
    if (!moves_effects) continue;
    const Case c = request.make_case(i);
    needs.longest_step = std::min(needs.longest_step, calc_longest_step(c));
    needs.has_sensors = needs.has_sensors || has_sensors(c.vehicle.effects);
  }
  return needs;
}

ManyResults simulate_many(const ManyRequest& request, double duration,
                          const std::atomic<bool>& stop) {
  ManyResults results = make_results(request, duration);
  std::vector<BatchSimulator> simulators;
  simulators.reserve(static_cast<std::size_t>(request.threads));
  for (int thread = 0; thread < request.threads; ++thread) {
    simulators.emplace_back(request.plan, list_kernels().front());
  }
  const std::size_t size = choose_item(request, simulators.front().batch_size());
  const std::size_t items = (request.count + size - 1) / size;
  share_items(request.threads, items, [&](std::size_t item, int thread) {
    if (stop) return;
    BatchSimulator& simulator = simulators[static_cast<std::size_t>(thread)];
    const std::size_t first = item * size;
    const std::vector<ReadyCase> ready = simulator.prepare(
        std::min(size, request.count - first),
        [&](std::size_t i) { return request.make_case(first + i); },
        [&](std::size_t i, RunStatus status, const std::string& reason) {
          fail(results, first + i, status, 0.0, reason);
        });
    for (std::size_t begin = 0; begin < ready.size() && !stop;) {
      begin += simulator.run_group(std::span(ready).subspan(begin),
                                   [&](std::size_t i, const LaneResults& run, int lane) {
                                     record(request, first + i, run, lane, results);
                                   });
    }
  });
  return results;
}

}  // namespace strut
