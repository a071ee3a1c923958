// The attempts of one task, recorded by the task itself: the only record without a scheduler's
// database.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file/folder.h"

namespace strut {

enum class TaskOutcome {
  kDone,     // all its shards exist
  kFailed,   // all its shards exist, but cases have no result
  kDrained,  // stopped between two shards after the warning of its time limit
  kStopped,  // stopped by a signal
  kError,    // ended by an error of input or environment
};

const char* get_name(TaskOutcome outcome);

/// One execution of a task, from its start to its end or to its being killed.
struct TaskAttempt {
  std::string host;
  std::int64_t begin = 0;  // s since 1970
  std::int64_t limit = 0;  // end of its time limit, s since 1970; 0: unknown
  int restart = 0;         // earlier starts by the scheduler
  std::optional<TaskOutcome> outcome;
  std::int64_t end = 0;     // s since 1970
  std::int64_t shards = 0;  // number of shards that it wrote
};

/// Fate of a task, from its last attempt and, if that was stopped or recorded no outcome, from the
/// scheduler.
enum class TaskFate {
  kNeverStarted,
  kDone,
  kFailed,
  kDrained,    // not put back into the queue
  kTimeout,    // its time limit ended before it could stop
  kPreempted,  // stopped or lost, and started again by the scheduler
  kCancelled,
  kError,
  kLost,  // ended without a recorded outcome: killed, out of memory, its node failed
};

const char* get_name(TaskFate fate);

/// Judges a task that is no longer queued. `scheduler_state`: its final state as the scheduler
/// remembers it; "" if it does not.
TaskFate judge_task(const std::vector<TaskAttempt>& attempts, bool cancelled,
                    const std::string& scheduler_state = "");

/// Reads a task's record in the folder of its array; empty if it is missing. Throws InputError if
/// strut cannot have written the file.
std::vector<TaskAttempt> read_task_attempts(const Folder& array, const std::string& task);
/// Writes a task's record; only the process that runs the task may do so. Throws EnvironmentError;
/// InputError if a link stands in place of the record.
void write_task_attempts(const Folder& array, const std::string& task,
                         const std::vector<TaskAttempt>& attempts);

}  // namespace strut
