// A task of a submission from the point of view of its own process, `strut run --task`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cluster/packing.h"
#include "cluster/submission.h"
#include "cluster/task_record.h"
#include "io/store/sweep_folder.h"

namespace strut {

/// Returns the name of a task for the script of a submission, SUBMISSION/ARRAY/TASK.
std::string make_task_name(const std::string& submission, std::size_t array,
                           const std::string& task);

class TaskRun {
 public:
  /// `name`: SUBMISSION/ARRAY/TASK. Throws InputError if there is no such task.
  TaskRun(const SweepFolder& folder, const std::string& name, std::int64_t shard_count);

  ShardRange shards() const { return shards_; }

  /// Records the start of an attempt. Throws EnvironmentError.
  void begin();
  /// Records its end. Throws EnvironmentError.
  void end(TaskOutcome outcome, std::int64_t shards_written);
  /// Returns whether the submission was cancelled.
  bool is_cancelled() const { return submission_.is_cancelled(); }

  /// Puts the task back into the queue to complete its shards, unless its last two attempts wrote
  /// no shard: the next would not either. Returns why it was not put back; "" if it was.
  std::string requeue() const;

 private:
  Submission submission_;
  ShardRange shards_;
  std::optional<Folder> array_;  // folder of the records of the array's tasks
  std::string file_;             // name of this task's record in it
  std::unique_ptr<Dispatcher> dispatcher_;
  std::vector<TaskAttempt> attempts_;
};

}  // namespace strut
