// The lives of one task, as it told them itself: the only account that is there without a
// scheduler's database.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file/folder.h"

namespace strut {

enum class TaskEnd {
  kDone,     // all its shards are there
  kFailed,   // they are, but cases have no result
  kDrained,  // stopped between two shards, warned of its time limit
  kStopped,  // by a signal
  kError,    // by an error of input or environment
};

const char* get_name(TaskEnd end);

/// From a task's begin to its end, or to its being killed.
struct TaskLife {
  std::string host;
  std::int64_t begin = 0;  // s since 1970
  std::int64_t limit = 0;  // when its time is over; 0: unknown
  int restart = 0;         // how often the scheduler began it before
  std::optional<TaskEnd> how;
  std::int64_t end = 0;
  std::int64_t shards = 0;  // that it wrote
};

/// What became of a task: of its last life, and where that was stopped or ended without a word, as
/// the scheduler says.
enum class TaskFate {
  kNeverBegun,
  kDone,
  kFailed,
  kDrained,    // and not put back into the queue
  kTimeout,    // its time was over before it could stop
  kPreempted,  // stopped or lost, and begun again by the scheduler
  kCancelled,
  kError,
  kLost,  // ended without a word: killed, out of memory, its node failed
};

const char* get_name(TaskFate fate);

/// Of a task that is not queued any more. `word`: how it ended as the scheduler remembers, "" where
/// it does not.
TaskFate judge_task(const std::vector<TaskLife>& lives, bool cancelled,
                    const std::string& word = "");

/// Of a task's record in the folder of its array; none where it is missing. Throws InputError where
/// the file is none of ours.
std::vector<TaskLife> read_task_lives(const Folder& array, const std::string& task);
/// Of the one process that runs the task. Throws EnvironmentError; InputError where a link stands
/// in its place.
void write_task_lives(const Folder& array, const std::string& task,
                      const std::vector<TaskLife>& lives);

}  // namespace strut
