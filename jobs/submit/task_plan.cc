#include "jobs/submit/task_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cluster/follow.h"
#include "cluster/slurm.h"
#include "jobs/case/plan_estimate.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

/// Walltime of a task relative to its expected duration: other processors are slower, and the
/// measurement was short.
constexpr double kReserve = 2.0;
/// Minimum time between a task's warning and the end of its walltime [s]: schedulers check once a
/// minute.
constexpr double kMinWarning = 60.0;

[[noreturn]] void refuse_time(double seconds, double min_seconds, double shard_seconds,
                              int threads) {
  throw InputError(
      fmt::format("--time {}: must be at least {}: one shard takes about {} on {}, and "
                  "tasks are warned "
                  "in time to finish it; use more --threads, or plan a sweep with smaller shards",
                  format_duration(seconds), format_duration(min_seconds),
                  format_duration(shard_seconds), format_count(threads, "thread")));
}

/// Duration of the longest task [s].
double calc_task_seconds(const std::vector<PackedArray>& arrays, double shard_seconds) {
  std::int64_t largest = 1;
  for (const PackedArray& array : arrays) largest = std::max(largest, array.get_task(0).count());
  return shard_seconds * static_cast<double>(largest);
}

}  // namespace

MissingWork find_missing_work(const OpenSweep& sweep, const SubmitRequest& request, bool is_dry) {
  MissingWork work;
  work.retries = request.retries;
  std::vector<ShardRange> live;
  for (const Submission& s : list_submissions(sweep.folder)) {
    if (s.is_finished()) continue;
    const SubmissionState state = follow(s);
    if (state.queue == QueueState::kUnknown && !request.ignores_unknown) {
      throw EnvironmentError(
          fmt::format("submission {}: unknown whether it still runs: {}; nothing is submitted; try "
                      "again later, or use --again",
                      s.name(), state.why_unknown));
    }
    // Only one process submits at a time: what a killed submit has not queued will not be queued.
    if (state.queue == QueueState::kEnded && !is_dry) s.mark_finished(state.scheduler_states);
    work.retries = work.retries && !state.retries;
    live.insert(live.end(), state.queued_shards.begin(), state.queued_shards.end());
  }
  const std::vector<std::int64_t> present = list_shards(sweep.folder);
  work.present = static_cast<std::int64_t>(present.size());
  work.shards = list_missing(sweep.plan.shard_count(), present, std::move(live));
  work.status = read_status(sweep.folder, sweep.plan);
  return work;
}

WorkEstimate estimate_work(const OpenSweep& sweep, const MissingWork& work) {
  std::int64_t missing = 0;
  for (const ShardRange& range : work.shards) {
    missing +=
        sweep.plan.shard_range(range.end - 1).second - sweep.plan.shard_range(range.first).first;
  }
  WorkEstimate estimate;
  double case_bytes = 0.0;
  const std::int64_t simulated = work.status.done + work.status.failed;
  if (simulated > 0) {
    estimate.case_seconds = work.status.simulation_seconds / static_cast<double>(simulated);
    case_bytes = static_cast<double>(work.status.bytes) / static_cast<double>(simulated);
  } else {
    const ProgressLine line("simulating a few cases for an estimate");
    const SweepEstimate whole = estimate_sweep(sweep.plan, list_kernels().front());
    const auto cases = static_cast<double>(sweep.plan.case_count());
    estimate.case_seconds = whole.core_seconds / cases;
    case_bytes = whole.bytes / cases;
  }
  estimate.core_seconds = estimate.case_seconds * static_cast<double>(missing);
  estimate.bytes = case_bytes * static_cast<double>(missing);
  return estimate;
}

std::string describe_work(const WorkEstimate& estimate) {
  return fmt::format("about {} and {}", describe_core_seconds(estimate.core_seconds),
                     format_bytes(estimate.bytes));
}

std::int64_t TaskPlan::count_tasks() const {
  std::int64_t tasks = 0;
  for (const PackedArray& array : arrays) tasks += array.tasks();
  return tasks;
}

TaskPlan plan_tasks(const MissingWork& work, double shard_seconds, const SubmitRequest& request,
                    const SiteLimits& limits, const Dispatcher& dispatcher) {
  TaskPlan plan;
  plan.resources = request.resources;
  Resources& resources = plan.resources;
  PackingRequest packing;
  packing.limits = limits;
  packing.shard_seconds = shard_seconds;
  packing.task_seconds = request.task_seconds;
  const bool has_walltime = dispatcher.name() == SlurmDispatcher::kName;
  if (has_walltime) {
    resources.warning = std::ceil(std::max(kMinWarning, kReserve * shard_seconds));
    const double max_seconds = resources.seconds > 0.0 ? resources.seconds : limits.seconds;
    const double min_seconds = 2.0 * resources.warning;
    if (max_seconds < min_seconds) {
      refuse_time(max_seconds, min_seconds, shard_seconds, resources.threads);
    }
    packing.task_seconds =
        std::min(packing.task_seconds, (max_seconds - resources.warning) / kReserve);
  }
  plan.arrays = pack_shards(work.shards, packing);
  plan.task_seconds = calc_task_seconds(plan.arrays, shard_seconds);
  if (has_walltime && resources.seconds == 0.0) {
    resources.seconds =
        std::min(limits.seconds, kReserve * plan.task_seconds + 2.0 * resources.warning);
  }
  return plan;
}

std::string describe_tasks(const TaskPlan& plan, const MissingWork& work) {
  if (plan.arrays.empty()) {
    return fmt::format("one task that retries, of {}, those that a smaller step may mend",
                       format_count(work.status.failed, "failed case"));
  }
  const std::int64_t tasks = plan.count_tasks();
  const auto arrays = static_cast<std::int64_t>(plan.arrays.size());
  const Resources& resources = plan.resources;
  std::string text = fmt::format(
      "{} in {}, each {}, about {} on {}", format_count(tasks, "task"),
      format_count(arrays, "array"), format_count(plan.arrays.front().shards_per_task, "shard"),
      format_duration(plan.task_seconds), format_count(resources.threads, "thread"));
  if (resources.seconds > 0.0) text += ", walltime " + format_slurm_time(resources.seconds);
  return text;
}

}  // namespace strut
