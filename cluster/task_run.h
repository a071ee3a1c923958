// A task from within: what `strut run --task` tells of itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cluster/packing.h"
#include "cluster/submission.h"
#include "cluster/task_record.h"
#include "io/store/sweep_folder.h"

namespace strut {

/// How a submission's script names a task.
std::string make_task_name(const std::string& submission, std::size_t array,
                           const std::string& task);

class TaskRun {
 public:
  /// `name`: SUBMISSION/ARRAY/TASK. Throws InputError where there is no such task.
  TaskRun(const SweepFolder& folder, const std::string& name, std::int64_t shard_count);

  ShardRange shards() const { return shards_; }

  /// Throws EnvironmentError.
  void begin();
  void end(TaskEnd how, std::int64_t shards_written);
  /// The submission was cancelled.
  bool is_cancelled() const { return submission_.is_cancelled(); }

  /// Back into the queue, for what was left undone. Not where the last two lives wrote no shard:
  /// the next would not either. Returns why it is not, "" where it is.
  std::string requeue() const;

 private:
  Submission submission_;
  ShardRange shards_;
  std::optional<Folder> array_;  // of the tasks' records
  std::string file_;             // there
  std::unique_ptr<Dispatcher> dispatcher_;
  std::vector<TaskLife> lives_;
};

}  // namespace strut
