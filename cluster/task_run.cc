#include "cluster/task_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"
#include "cluster/record_file.h"
#include "io/file/process_identity.h"

namespace strut {

std::string make_task_name(const std::string& submission, std::size_t array,
                           const std::string& task) {
  return fmt::format("{}/{}/{}", submission, array, task);
}

TaskRun::TaskRun(const SweepFolder& folder, const std::string& name, std::int64_t shard_count) {
  const auto error = [&name](const std::string& what) {
    return InputError(fmt::format("--task {}: {}", name, what));
  };
  const std::size_t first = name.find('/');
  const std::size_t second = first == std::string::npos ? first : name.find('/', first + 1);
  if (second == std::string::npos) throw error("must be SUBMISSION/ARRAY/TASK");
  submission_ = find_submission(folder, name.substr(0, first));
  const auto array = parse_number<std::size_t>(name.substr(first + 1, second - first - 1));
  const auto task = parse_number<std::int64_t>(name.substr(second + 1));
  if (!array || *array >= submission_.arrays.size() || !task || *task < 0 ||
      *task >= submission_.arrays[*array].tasks()) {
    throw error(
        fmt::format("submission {} has no such task; `strut run` without --task does all "
                    "missing shards",
                    submission_.name()));
  }
  const PackedArray& packed = submission_.arrays[*array];
  if (packed.shards.end > shard_count) {
    throw error(fmt::format("{}: not of this sweep: it has shards up to {}, the plan {}; {}",
                            submission_.folder.string(), packed.shards.end, shard_count,
                            kRecordRemedy));
  }
  shards_ = packed.get_task(*task);
  array_ = submission_.open().make_folder(submission_.array_name(*array));
  file_ = std::to_string(*task);
  dispatcher_ = make_dispatcher(submission_.dispatcher);
}

void TaskRun::begin() {
  attempts_ = read_task_attempts(*array_, file_);
  TaskAttempt attempt;
  attempt.host = find_own_identity().host;
  attempt.begin = std::time(nullptr);
  attempt.limit = dispatcher_->find_own_deadline();
  attempt.restart = dispatcher_->count_own_restarts();
  attempts_.push_back(attempt);
  write_task_attempts(*array_, file_, attempts_);
}

void TaskRun::end(TaskOutcome outcome, std::int64_t shards_written) {
  TaskAttempt& attempt = attempts_.back();
  attempt.outcome = outcome;
  attempt.end = std::time(nullptr);
  attempt.shards = shards_written;
  write_task_attempts(*array_, file_, attempts_);
}

std::string TaskRun::requeue() const {
  // One attempt without a shard may be bad luck: an early warning, shards claimed by other tasks.
  const auto wrote_none = [](const TaskAttempt& attempt) { return attempt.shards == 0; };
  if (attempts_.size() > 1 && std::all_of(attempts_.end() - 2, attempts_.end(), wrote_none)) {
    return "two attempts finished no shard; submit again with a longer --time";
  }
  if (submission_.is_cancelled()) return "it was cancelled";
  if (!dispatcher_->requeue_own()) {
    return fmt::format("{} cannot put it back into the queue", dispatcher_->name());
  }
  return "";
}

}  // namespace strut
