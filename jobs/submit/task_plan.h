// The tasks of a submission: which shards are missing, how long one takes, how many a task gets.
#pragma once

#include <string>
#include <vector>

#include "cluster/packing.h"
#include "cluster/submission.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/submit/request.h"
#include "sweep/status.h"

namespace strut {

/// Missing shards of a sweep: those that neither exist nor belong to a task that waits or runs.
struct MissingWork {
  std::vector<ShardRange> shards;
  std::int64_t present = 0;  // shards that exist
  SweepStatus status;
  bool retries = false;  // failed cases are to be retried, and no earlier task will do so

  bool is_empty() const { return shards.empty() && !(retries && status.failed > 0); }
};

/// Looks at the files of the sweep and at its submissions; unless `is_dry`, submissions that have
/// ended are marked as over. Throws EnvironmentError if it is unknown whether one has ended, unless
/// the request ignores that.
MissingWork find_missing_work(const OpenSweep& sweep, const SubmitRequest& request, bool is_dry);

/// Time and size of the missing work: from the shards that exist, or, without any, from a few cases
/// simulated now.
struct WorkEstimate {
  double case_seconds = 0.0;  // processor time of a case
  double core_seconds = 0.0;  // of all missing cases
  double bytes = 0.0;         // of their shards' files
};

WorkEstimate estimate_work(const OpenSweep& sweep, const MissingWork& work);

struct TaskPlan {
  std::vector<PackedArray> arrays;
  Resources resources;        // for one task, walltime and warning included
  double task_seconds = 0.0;  // expected duration of the longest task

  std::int64_t count_tasks() const;
};

/// Packs the missing shards into tasks and chooses their walltime. Throws InputError if one shard
/// does not fit into --time.
TaskPlan plan_tasks(const MissingWork& work, double shard_seconds, const SubmitRequest& request,
                    const SiteLimits& limits, const Dispatcher& dispatcher);

/// "12 tasks in 1 array, each 5 shards, about 10 min 0 s on 8 threads, walltime 00:21:00"
std::string describe_tasks(const TaskPlan& plan, const MissingWork& work);
/// "about 15.2 core-hours and 71 MB"
std::string describe_work(const WorkEstimate& estimate);

}  // namespace strut
