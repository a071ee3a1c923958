#include "cluster/task_run.h"

#include <algorithm>
#include <ctime>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"
#include "cluster/record_file.h"
#include "io/file/process_identity.h"

namespace strut {
std::string make_task_name(const std::string& submission, std::size_t array,
                           const std::string& task) {
  return submission + "/" + std::to_string(array) + "/" + task;
}

TaskRun::TaskRun(const SweepFolder& folder, const std::string& name, std::int64_t shard_count) {
  const std::size_t first = name.find('/');
  const std::size_t second = first == std::string::npos ? first : name.find('/', first + 1);
  if (second == std::string::npos) {
    throw InputError("--task " + name + ": must be SUBMISSION/ARRAY/TASK");
  }
  submission_ = find_submission(folder, name.substr(0, first));
  const auto array = parse_number<std::size_t>(name.substr(first + 1, second - first - 1));
  const auto task = parse_number<std::int64_t>(name.substr(second + 1));
  if (!array || *array >= submission_.arrays.size() || !task || *task < 0 ||
      *task >= submission_.arrays[*array].tasks()) {
    throw InputError("--task " + name + ": submission " + submission_.name() +
                     " has no such task; `strut run` without --task does all that is missing");
  }
  if (submission_.arrays[*array].shards.end > shard_count) {
    throw InputError("--task " + name + ": " + submission_.folder.string() +
                     ": not of this sweep: it has shards up to " +
                     std::to_string(submission_.arrays[*array].shards.end) + ", the plan " +
                     std::to_string(shard_count) + kRecordRemedy);
  }
  shards_ = submission_.arrays[*array].get_task(*task);
  array_ = submission_.open().make_folder(submission_.array_name(*array));
  file_ = std::to_string(*task);
  dispatcher_ = make_dispatcher(submission_.dispatcher);
}

void TaskRun::begin() {
  lives_ = read_task_lives(*array_, file_);
  TaskLife life;
  life.host = find_own_identity().host;
  life.begin = std::time(nullptr);
  life.limit = dispatcher_->find_own_end();
  life.restart = dispatcher_->count_own_restarts();
  lives_.push_back(life);
  write_task_lives(*array_, file_, lives_);
}

void TaskRun::end(TaskEnd how, std::int64_t shards_written) {
  TaskLife& life = lives_.back();
  life.how = how;
  life.end = std::time(nullptr);
  life.shards = shards_written;
  write_task_lives(*array_, file_, lives_);
}

std::string TaskRun::requeue() const {
  // Once may be bad luck: a warning that came early, shards in other tasks' hands.
  const auto wrote_none = [](const TaskLife& life) { return life.shards == 0; };
  if (lives_.size() > 1 && std::all_of(lives_.end() - 2, lives_.end(), wrote_none)) {
    return "not one shard was finished in two lives; submit again with a longer --time";
  }
  if (submission_.is_cancelled()) return "it was cancelled";
  if (!dispatcher_->requeue_own()) return dispatcher_->name() + " does not take it back";
  return "";
}

}  // namespace strut
