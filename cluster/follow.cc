#include "cluster/follow.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error/input_error.h"
#include "base/names/name_table.h"

namespace strut {
namespace {

constexpr std::array<Named<QueueState>, 3> kQueueStates = {{{QueueState::kQueued, "queued"},
                                                            {QueueState::kEnded, "ended"},
                                                            {QueueState::kUnknown, "unknown"}}};
static_assert(names_all(kQueueStates, QueueState::kUnknown));

/// Tasks that wait or run, as the scheduler numbers them.
struct QueuedIds {
  std::set<std::pair<std::size_t, std::int64_t>> tasks;  // array and task
  std::set<std::size_t> arrays;  // arrays that run as one job, whose tasks have no numbers
};

std::optional<std::size_t> find_array(const Submission& submission, const std::string& part) {
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    if (submission.array_name(i) == part) return i;
  }
  return std::nullopt;
}

/// A part of a submission; only arrays have an index.
struct Part {
  std::string name;
  std::optional<std::size_t> array;
};

std::map<std::string, Part> map_jobs_to_parts(const Submission& submission,
                                              const std::vector<JobRecord>& jobs) {
  std::map<std::string, Part> parts;
  for (const JobRecord& record : jobs) {
    parts[record.job] = {record.part, find_array(submission, record.part)};
  }
  return parts;
}

/// Returns why the scheduler here cannot report on a submission; "" if it can.
std::string find_obstacle(const Submission& submission, const Dispatcher& dispatcher) {
  if (submission.user != find_user()) {
    return fmt::format("it belongs to another user ({})", submission.user);
  }
  if (submission.cluster_name != dispatcher.find_cluster_name()) {
    return fmt::format("it was submitted to another cluster ({})", submission.cluster_name);
  }
  return "";
}

/// Adds the shards and numbers of tasks of an array that wait or run.
void add_queued(const Submission& submission, std::size_t array, const QueuedTasks& tasks,
                SubmissionState& state, QueuedIds& queued) {
  const PackedArray& packed = submission.arrays[array];
  if (tasks.task < 0) {
    state.queued_shards.push_back(packed.shards);
    queued.arrays.insert(array);
    return;
  }
  for (std::int64_t t = tasks.task; t < tasks.task + tasks.count; ++t) {
    state.queued_shards.push_back(packed.get_task(t));
    queued.tasks.insert({array, t});
  }
}

/// Adds the scheduler's report on tasks of a part.
void add_report(const Submission& submission, const Part& part, const QueuedTasks& tasks,
                SubmissionState& state, QueuedIds& queued) {
  if (tasks.state == TaskState::kEnded) {
    if (part.array) state.scheduler_states[{*part.array, tasks.task}] = tasks.scheduler_state;
    return;
  }
  if (tasks.state == TaskState::kPending) {
    state.pending += tasks.count;
    state.reasons[tasks.reason] += tasks.count;
  } else {
    state.running += tasks.count;
  }
  if (part.name == Submission::kRetry) state.retries = true;
  if (part.array) add_queued(submission, *part.array, tasks, state, queued);
}

/// Sets all that the scheduler knows; without an answer the state of the queue stays unknown.
void ask_scheduler(const Submission& submission, SubmissionState& state, QueuedIds& queued) {
  try {
    const auto dispatcher = make_dispatcher(submission.dispatcher);
    state.why_unknown = find_obstacle(submission, *dispatcher);
    if (!state.why_unknown.empty()) return;
    const std::vector<JobRecord> jobs = find_jobs(submission, *dispatcher);
    const QueueAnswer answer = dispatcher->query(jobs);
    state.why_unknown = answer.failure;
    if (!state.why_unknown.empty()) return;
    const std::map<std::string, Part> parts = map_jobs_to_parts(submission, jobs);
    for (const QueuedTasks& tasks : answer.tasks) {
      add_report(submission, parts.at(tasks.job), tasks, state, queued);
    }
  } catch (const EnvironmentError& e) {
    state.why_unknown = e.what();
    return;
  }
  const bool any = state.pending + state.running > 0;
  state.queue = any ? QueueState::kQueued : QueueState::kEnded;
}

/// Marks a submission that has ended as finished, unless a submit may still be queuing its jobs.
void mark_ended(const Submission& submission, const SchedulerStates& states) {
  for (const std::string& part : submission.list_parts()) {
    if (submission.read_job(part).job.empty()) return;
  }
  try {
    submission.mark_finished(states);
  } catch (const EnvironmentError&) {
    // The folder is read-only: the scheduler is asked again next time.
  }
}

/// Returns whether a task waits or runs. In a job without task numbers, tasks without an outcome
/// do.
bool is_queued(const QueuedIds& queued, std::size_t array, std::int64_t task,
               const std::vector<TaskAttempt>& attempts) {
  if (queued.tasks.contains({array, task})) return true;
  return queued.arrays.contains(array) && (attempts.empty() || !attempts.back().outcome);
}

/// Counts the fates of all array tasks that are not queued, and the restarts, from the tasks'
/// records.
void judge_tasks(const Submission& submission, const QueuedIds& queued, SubmissionState& state) {
  const Folder folder = submission.open();
  const bool is_cancelled = submission.is_cancelled();
  for (std::size_t a = 0; a < submission.arrays.size(); ++a) {
    const auto array = folder.find_folder(submission.array_name(a));
    for (std::int64_t t = 0; t < submission.arrays[a].tasks(); ++t) {
      std::vector<TaskAttempt> attempts;
      if (array) attempts = read_task_attempts(*array, std::to_string(t));
      if (attempts.size() > 1) state.restarts += static_cast<std::int64_t>(attempts.size()) - 1;
      if (is_queued(queued, a, t, attempts)) continue;
      const auto known = state.scheduler_states.find({a, t});
      const bool is_known = known != state.scheduler_states.end();
      ++state.fates[judge_task(attempts, is_cancelled, is_known ? known->second : "")];
    }
  }
}

}  // namespace

const char* get_name(QueueState state) { return find_name(kQueueStates, state); }

std::vector<JobRecord> find_jobs(const Submission& submission, const Dispatcher& dispatcher) {
  std::vector<JobRecord> jobs;
  for (const std::string& part : submission.list_parts()) {
    JobRecord record = submission.read_job(part);
    if (record.job.empty()) record.job = dispatcher.find_job(record);
    if (!record.job.empty()) jobs.push_back(std::move(record));
  }
  return jobs;
}

SubmissionState follow(const Submission& submission) {
  SubmissionState state;
  QueuedIds queued;
  if (submission.is_finished()) {
    state.queue = QueueState::kEnded;
    state.scheduler_states = submission.read_scheduler_states();
  } else {
    ask_scheduler(submission, state, queued);
    if (state.queue == QueueState::kEnded) mark_ended(submission, state.scheduler_states);
  }
  if (state.queue != QueueState::kUnknown) judge_tasks(submission, queued, state);
  return state;
}

}  // namespace strut
