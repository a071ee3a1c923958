#include "estimate/crossing_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "estimate/run_prepared.h"
#include "model/effects/catalogue.h"
#include "model/error/model_error.h"
#include "model/sensor/sensors.h"

namespace strut {
namespace {

std::string explain_failure(const std::string& run, const LaneRun& result) {
  return fmt::format(
      "{}: the simulation ends at t = {} s: {}", run,
      format_number(result.results->failure_time[static_cast<std::size_t>(result.lane)]),
      get_name(result.status()));
}

using PreparedCases = std::vector<std::optional<PreparedCase>>;  // null: failed

/// Prepares tasks [begin, end); sets the failure in `results` of those that cannot be prepared.
PreparedCases prepare_tasks(const std::vector<MeasuredRun>& runs,
                            const std::vector<CrossingTask>& tasks, std::size_t begin,
                            std::size_t end, int threads, std::vector<CasePreparer>& preparers,
                            std::vector<CrossingResult>& results) {
  PreparedCases prepared(end - begin);
  const auto prepare = [&](std::size_t i, CasePreparer& preparer) {
    try {
      prepared[i - begin] = preparer.prepare(remove_sensors(tasks[i].setup));
    } catch (const ModelError& e) {
      results[i].failure = fmt::format("{}: {}", runs[tasks[i].run].name, e.what());
    }
  };
  // A run's first task is its base point, close to the others.
  std::vector<std::size_t> others;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t run = tasks[i].run;
    if (i == 0 || tasks[i - 1].run != run) {
      prepare(i, preparers[run]);
    } else {
      others.push_back(i);
    }
  }
  share_items(threads, others.size(), [&](std::size_t k, int /*thread*/) {
    // A copy, since a changed mechanism must not replace the base point's in the preparer.
    CasePreparer preparer = preparers[tasks[others[k]].run];
    prepare(others[k], preparer);
  });
  return prepared;
}

/// Simulates the prepared cases, the first of which is task number `begin`, into `results`.
void run_tasks(const std::vector<MeasuredRun>& runs, const std::vector<CrossingTask>& tasks,
               std::size_t begin, PreparedCases prepared, const LinearizeOptions& options,
               std::vector<CrossingResult>& results) {
  SamplePlan plan;
  plan.interval = 1.0 / options.rate;
  plan.snapshot = false;
  plan.recorded = list_recorded(runs);
  std::vector<PreparedCase> cases;
  std::vector<std::size_t> numbers;  // of the cases' tasks
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    if (!prepared[i]) continue;
    cases.push_back(std::move(*prepared[i]));
    cases.back().longest_step = std::min(cases.back().longest_step, tasks[begin + i].longest_step);
    numbers.push_back(begin + i);
  }
  const std::vector<LaneRun> simulated =
      run_prepared(cases, options.integrate, plan, options.threads);
  for (std::size_t k = 0; k < simulated.size(); ++k) {
    CrossingResult& result = results[numbers[k]];
    const MeasuredRun& run = runs[tasks[numbers[k]].run];
    result.was_simulated = true;
    if (simulated[k].status() != RunStatus::kDone) {
      result.failure = explain_failure(run.name, simulated[k]);
    } else {
      result.sampled = get_channels(run, simulated[k]);
    }
  }
}

}  // namespace

std::vector<int> list_recorded(const std::vector<MeasuredRun>& runs) {
  std::set<int> channels;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) channels.insert(c.channel);
  }
  return {channels.begin(), channels.end()};
}

SampledRun get_channels(const MeasuredRun& run, const LaneRun& result) {
  SampledRun sampled;
  sampled.reserve(run.channels.size());
  for (const MeasuredChannel& c : run.channels) sampled.push_back(result.get_series(c.channel));
  return sampled;
}

std::vector<CrossingResult> simulate_crossings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<CrossingTask>& tasks,
                                               const LinearizeOptions& options,
                                               std::vector<CasePreparer>& preparers) {
  // Limits the histories in memory to a few hundred megabytes.
  constexpr std::size_t kAtOnce = 128;
  std::vector<CrossingResult> results(tasks.size());
  for (std::size_t begin = 0; begin < tasks.size(); begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, tasks.size());
    PreparedCases prepared =
        prepare_tasks(runs, tasks, begin, end, options.threads, preparers, results);
    run_tasks(runs, tasks, begin, std::move(prepared), options, results);
  }
  return results;
}

bool has_sensors(const Case& c) {
  return std::any_of(c.vehicle.effects.begin(), c.vehicle.effects.end(), is_sensor_setting);
}

Case remove_sensors(Case c) {
  std::erase_if(c.vehicle.effects, is_sensor_setting);
  return c;
}

SampledRun read_sensors(const Case& setup, const MeasuredRun& run, double interval,
                        SampledRun sampled) {
  for (std::size_t c = 0; c < sampled.size(); ++c) {
    const auto channel = static_cast<std::size_t>(run.channels[c].channel);
    sampled[c] = read_sensor(setup.vehicle.effects, run.setup.info().channels[channel], interval,
                             std::move(sampled[c]));
  }
  return sampled;
}

}  // namespace strut
