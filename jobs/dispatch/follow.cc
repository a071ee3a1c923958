#include "jobs/dispatch/follow.h"

#include <array>
#include <set>

#include "io/input_error.h"

namespace strut {
namespace {

/// The parts' jobs; also of those that were queued by a submit that was killed before it could say
/// so. Throws EnvironmentError where that cannot be told.
std::map<std::string, std::string> find_jobs(const Submission& submission,
                                             const Dispatcher& dispatcher) {
  std::map<std::string, std::string> part_of_job;
  for (const std::string& part : submission.list_parts()) {
    std::string job = submission.read_job(part);
    if (job.empty()) job = dispatcher.find_job(submission.job_name(part));
    if (!job.empty()) part_of_job[job] = part;
  }
  return part_of_job;
}

std::optional<std::size_t> find_array(const Submission& submission, const std::string& part) {
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    if (submission.array_name(i) == part) return i;
  }
  return std::nullopt;
}

/// What the scheduler remembers of the end of a task that ended without a word.
TaskFate judge_word(const std::string& word) {
  if (word == "TIMEOUT" || word == "DEADLINE") return TaskFate::kTimeout;
  if (word == "PREEMPTED") return TaskFate::kPreempted;
  if (word == "CANCELLED") return TaskFate::kCancelled;
  return TaskFate::kLost;
}

class Follower {
 public:
  explicit Follower(const Submission& submission) : submission_(submission) {}

  SubmissionState follow() {
    if (submission_.is_over()) {
      state_.queue = QueueState::kEnded;
    } else {
      ask();
    }
    if (state_.queue != QueueState::kUnknown) read_tasks();
    return state_;
  }

 private:
  void ask() {
    const auto dispatcher = make_dispatcher(submission_.dispatcher);
    std::optional<std::vector<QueuedTasks>> queued;
    std::map<std::string, std::string> part_of_job;
    try {
      part_of_job = find_jobs(submission_, *dispatcher);
      std::vector<std::string> jobs;
      for (const auto& [job, part] : part_of_job) jobs.push_back(job);
      queued = dispatcher->query(jobs);
      if (!queued) state_.why = dispatcher->explain_silence();
    } catch (const EnvironmentError& e) {
      state_.why = e.what();
    }
    if (!queued) return;
    for (const QueuedTasks& tasks : *queued) count(tasks, part_of_job[tasks.job]);
    const bool any = state_.pending + state_.running > 0;
    state_.queue = any ? QueueState::kQueued : QueueState::kEnded;
  }

  void count(const QueuedTasks& tasks, const std::string& part) {
    const auto array = find_array(submission_, part);
    if (tasks.state == TaskState::kEnded) {
      if (array) words_[{*array, tasks.task}] = tasks.word;
      return;
    }
    if (tasks.state == TaskState::kPending) {
      state_.pending += tasks.count;
      state_.reasons[tasks.reason] += tasks.count;
    } else {
      state_.running += tasks.count;
    }
    if (!array) return;
    const PackedArray& packed = submission_.arrays[*array];
    if (tasks.task < 0) {
      state_.live.push_back(packed.shards);
      whole_.insert(*array);
      return;
    }
    for (std::int64_t t = tasks.task; t < tasks.task + tasks.count; ++t) {
      state_.live.push_back(packed.get_task(t));
      live_.insert({*array, t});
    }
  }

  void read_tasks() {
    for (std::size_t a = 0; a < submission_.arrays.size(); ++a) {
      for (std::int64_t t = 0; t < submission_.arrays[a].tasks(); ++t) read_task(a, t);
    }
  }

  void read_task(std::size_t array, std::int64_t task) {
    const auto lives = read_task_lives(submission_.tasks(array) / std::to_string(task));
    if (lives.size() > 1) state_.restarts += static_cast<std::int64_t>(lives.size()) - 1;
    if (live_.count({array, task}) > 0) return;
    // Of a job that has no numbers for its tasks, those that have not ended are live.
    if (whole_.count(array) > 0 && (lives.empty() || !lives.back().how)) return;
    TaskFate fate = judge_task(lives, submission_.is_cancelled());
    const auto word = words_.find({array, task});
    if (fate == TaskFate::kLost && word != words_.end()) fate = judge_word(word->second);
    ++state_.fates[fate];
  }

  const Submission& submission_;
  SubmissionState state_;
  using TaskKey = std::pair<std::size_t, std::int64_t>;
  std::set<TaskKey> live_;
  std::set<std::size_t> whole_;
  std::map<TaskKey, std::string> words_;
};

}  // namespace

const char* get_name(QueueState state) {
  constexpr std::array<const char*, 3> kNames = {"queued", "ended", "unknown"};
  return kNames[static_cast<std::size_t>(state)];
}

SubmissionState follow(const Submission& submission) { return Follower(submission).follow(); }

}  // namespace strut
