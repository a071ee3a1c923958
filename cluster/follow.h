// Progress of a submission, from its scheduler and from the records of its tasks.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cluster/submission.h"
#include "cluster/task_record.h"

namespace strut {

enum class QueueState {
  kQueued,   // tasks wait or run
  kEnded,    // no task waits or runs
  kUnknown,  // the scheduler gives no answer: neither of the above may be assumed
};

const char* get_name(QueueState state);

struct SubmissionState {
  QueueState queue = QueueState::kUnknown;
  std::string why_unknown;  // reason for kUnknown
  std::int64_t pending = 0, running = 0;
  std::map<std::string, std::int64_t> reasons;  // why tasks wait -> tasks
  std::map<TaskFate, std::int64_t> fates;       // array tasks that are not queued
  std::int64_t restarts = 0;                    // attempts after the first of each task
  std::vector<ShardRange> queued_shards;        // shards of tasks that wait or run
  bool retries = false;                         // its task for failed cases waits or runs
  SchedulerStates scheduler_states;             // tasks that ended
};

/// Determines the state of a submission. If it was queued in full and has ended, marks it as
/// finished: its scheduler is not asked again. Throws InputError if its files are damaged or name a
/// job that cannot be its own.
SubmissionState follow(const Submission& submission);

/// Finds the jobs of a submission, including those that a killed submit queued without recording
/// them. Throws EnvironmentError if they cannot be determined.
std::vector<JobRecord> find_jobs(const Submission& submission, const Dispatcher& dispatcher);

}  // namespace strut
