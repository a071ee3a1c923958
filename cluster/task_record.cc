#include "cluster/task_record.h"

#include <fmt/format.h>

#include <array>
#include <sstream>

#include "base/names/name_table.h"
#include "cluster/record_file.h"
#include "io/file/atomic_file.h"

namespace strut {
namespace {

constexpr std::array<Named<TaskOutcome>, 5> kOutcomes = {{{TaskOutcome::kDone, "done"},
                                                          {TaskOutcome::kFailed, "failed"},
                                                          {TaskOutcome::kDrained, "drained"},
                                                          {TaskOutcome::kStopped, "stopped"},
                                                          {TaskOutcome::kError, "error"}}};
static_assert(names_all(kOutcomes, TaskOutcome::kError));
/// In place of an outcome, while a task runs.
constexpr char kBegun[] = "begun";
constexpr std::array<Named<TaskFate>, 9> kFates = {{{TaskFate::kNeverStarted, "never begun"},
                                                    {TaskFate::kDone, "done"},
                                                    {TaskFate::kFailed, "failed"},
                                                    {TaskFate::kDrained, "drained"},
                                                    {TaskFate::kTimeout, "timeout"},
                                                    {TaskFate::kPreempted, "preempted"},
                                                    {TaskFate::kCancelled, "cancelled"},
                                                    {TaskFate::kError, "error"},
                                                    {TaskFate::kLost, "lost"}}};
static_assert(names_all(kFates, TaskFate::kLost));
/// A task that is stopped this close to the end of its time limit was stopped by it [s].
constexpr std::int64_t kTimeoutMargin = 5;

std::optional<TaskFate> find_fate(const std::string& scheduler_state) {
  if (scheduler_state == "TIMEOUT" || scheduler_state == "DEADLINE") return TaskFate::kTimeout;
  if (scheduler_state == "PREEMPTED") return TaskFate::kPreempted;
  if (scheduler_state == "CANCELLED") return TaskFate::kCancelled;
  return std::nullopt;
}

}  // namespace

const char* get_name(TaskOutcome outcome) { return find_name(kOutcomes, outcome); }
const char* get_name(TaskFate fate) { return find_name(kFates, fate); }

TaskFate judge_task(const std::vector<TaskAttempt>& attempts, bool cancelled,
                    const std::string& scheduler_state) {
  const bool has_started = !attempts.empty();
  const TaskAttempt last = has_started ? attempts.back() : TaskAttempt();
  if (last.outcome == TaskOutcome::kDone) return TaskFate::kDone;
  if (last.outcome == TaskOutcome::kFailed) return TaskFate::kFailed;
  if (last.outcome == TaskOutcome::kError) return TaskFate::kError;
  if (cancelled) return TaskFate::kCancelled;
  if (last.outcome == TaskOutcome::kDrained) return TaskFate::kDrained;
  if (const auto fate = find_fate(scheduler_state)) return *fate;
  if (!has_started) return scheduler_state.empty() ? TaskFate::kNeverStarted : TaskFate::kLost;
  if (last.outcome == TaskOutcome::kStopped) {
    const bool in_time = last.limit == 0 || last.end < last.limit - kTimeoutMargin;
    return in_time ? TaskFate::kPreempted : TaskFate::kTimeout;
  }
  return TaskFate::kLost;
}

std::vector<TaskAttempt> read_task_attempts(const Folder& array, const std::string& task) {
  std::vector<TaskAttempt> attempts;
  std::istringstream lines(read_record_file(array, task).value_or(""));
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    TaskAttempt attempt;
    std::string outcome;
    if (!(words >> attempt.host >> attempt.begin >> attempt.limit >> attempt.restart >> outcome >>
          attempt.end >> attempt.shards)) {
      throw InputError(fmt::format("{}:{}: not an attempt of a task; {}",
                                   array.path_of(task).string(), attempts.size() + 1,
                                   kRecordRemedy));
    }
    attempt.outcome = find_value(kOutcomes, outcome);
    attempts.push_back(attempt);
  }
  return attempts;
}

void write_task_attempts(const Folder& array, const std::string& task,
                         const std::vector<TaskAttempt>& attempts) {
  std::string text;
  for (const TaskAttempt& attempt : attempts) {
    text += fmt::format("{} {} {} {} {} {} {}\n", attempt.host, attempt.begin, attempt.limit,
                        attempt.restart, attempt.outcome ? get_name(*attempt.outcome) : kBegun,
                        attempt.end, attempt.shards);
  }
  write_text_file(array, task, text);
}

}  // namespace strut
