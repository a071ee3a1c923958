#include "cluster/task_record.h"

#include <array>
#include <sstream>

#include "cluster/record_file.h"
#include "io/file/atomic_file.h"

namespace strut {
namespace {

constexpr std::array<const char*, 5> kEnds = {"done", "failed", "drained", "stopped", "error"};
constexpr std::array<const char*, 9> kFates = {"never begun", "done",    "failed",
                                               "drained",     "timeout", "preempted",
                                               "cancelled",   "error",   "lost"};
/// How long before its time limit a task may already be stopped for it [s].
constexpr std::int64_t kBefore = 5;

std::optional<TaskEnd> find_end(const std::string& name) {
  for (std::size_t i = 0; i < kEnds.size(); ++i) {
    if (name == kEnds[i]) return static_cast<TaskEnd>(i);
  }
  return std::nullopt;
}

std::optional<TaskFate> find_fate(const std::string& word) {
  if (word == "TIMEOUT" || word == "DEADLINE") return TaskFate::kTimeout;
  if (word == "PREEMPTED") return TaskFate::kPreempted;
  if (word == "CANCELLED") return TaskFate::kCancelled;
  return std::nullopt;
}

}  // namespace

const char* get_name(TaskEnd end) { return kEnds[static_cast<std::size_t>(end)]; }
const char* get_name(TaskFate fate) { return kFates[static_cast<std::size_t>(fate)]; }

TaskFate judge_task(const std::vector<TaskLife>& lives, bool cancelled, const std::string& word) {
  const bool has_begun = !lives.empty();
  const TaskLife last = has_begun ? lives.back() : TaskLife();
  if (last.how == TaskEnd::kDone) return TaskFate::kDone;
  if (last.how == TaskEnd::kFailed) return TaskFate::kFailed;
  if (last.how == TaskEnd::kError) return TaskFate::kError;
  if (cancelled) return TaskFate::kCancelled;
  if (last.how == TaskEnd::kDrained) return TaskFate::kDrained;
  if (const auto fate = find_fate(word)) return *fate;
  if (!has_begun) return word.empty() ? TaskFate::kNeverBegun : TaskFate::kLost;
  if (last.how == TaskEnd::kStopped) {
    const bool in_time = last.limit == 0 || last.end < last.limit - kBefore;
    return in_time ? TaskFate::kPreempted : TaskFate::kTimeout;
  }
  return TaskFate::kLost;
}

std::vector<TaskLife> read_task_lives(const Folder& array, const std::string& task) {
  std::vector<TaskLife> lives;
  std::istringstream lines(read_record_file(array, task).value_or(""));
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    TaskLife life;
    std::string how;
    if (!(words >> life.host >> life.begin >> life.limit >> life.restart >> how >> life.end >>
          life.shards)) {
      throw InputError(array.path_of(task).string() + ": line " + std::to_string(lives.size() + 1) +
                       ": not the life of a task" + kRecordRemedy);
    }
    life.how = find_end(how);
    lives.push_back(life);
  }
  return lives;
}

void write_task_lives(const Folder& array, const std::string& task,
                      const std::vector<TaskLife>& lives) {
  std::ostringstream text;
  for (const TaskLife& life : lives) {
    text << life.host << ' ' << life.begin << ' ' << life.limit << ' ' << life.restart << ' '
         << (life.how ? get_name(*life.how) : "begun") << ' ' << life.end << ' ' << life.shards
         << '\n';
  }
  write_text_file(array, task, text.str());
}

}  // namespace strut
