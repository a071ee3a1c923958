// How far a submission has come: what its scheduler says, and what its tasks told.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/dispatch/submission.h"
#include "jobs/dispatch/task_record.h"

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
};

/// Looks; changes nothing. A submission that is over is not asked about.
SubmissionState follow(const Submission& submission);

}  // namespace strut
