// How far a submission has come: what its scheduler says, and what its tasks told.
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
  kEnded,    // none does
  kUnknown,  // the scheduler does not say: neither of the above may be assumed
};

const char* get_name(QueueState state);

struct SubmissionState {
  QueueState queue = QueueState::kUnknown;
  std::string why;  // it is unknown
  std::int64_t pending = 0, running = 0;
  std::map<std::string, std::int64_t> reasons;  // for which tasks wait
  std::map<TaskFate, std::int64_t> fates;       // of array tasks that are not queued
  std::int64_t restarts = 0;                    // lives beyond each task's first
  std::vector<ShardRange> live;                 // shards of tasks that wait or run
  bool retries = false;                         // its task for failed cases waits or runs
  TaskWords words;                              // of tasks that ended
};

/// Looks, and marks a submission that was queued in full and has ended as over: of such a one
/// nobody is asked again. Throws InputError where its files are damaged, or name a job that is none
/// of its own.
SubmissionState follow(const Submission& submission);

/// The jobs of a submission; those included that were queued by a submit that was killed before it
/// could say so. Throws EnvironmentError where that cannot be told.
std::vector<JobRecord> find_jobs(const Submission& submission, const Dispatcher& dispatcher);

}  // namespace strut
