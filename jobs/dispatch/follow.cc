#include "jobs/dispatch/follow.h"

#include <array>
#include <set>

#include "io/input_error.h"

namespace strut {
namespace {

std::optional<std::size_t> find_array(const Submission& submission, const std::string& part) {
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    if (submission.array_name(i) == part) return i;
  }
  return std::nullopt;
}

class Follower {
 public:
  explicit Follower(const Submission& submission) : submission_(submission) {}

  SubmissionState follow() {
    if (submission_.is_over()) {
      state_.queue = QueueState::kEnded;
      state_.words = submission_.read_words();
    } else {
      ask();
      if (state_.queue == QueueState::kEnded) remember_end();
    }
    if (state_.queue != QueueState::kUnknown) read_tasks();
    return state_;
  }

 private:
  /// Not of one that a submit may still be working on.
  void remember_end() {
    for (const std::string& part : submission_.list_parts()) {
      if (submission_.read_job(part).empty()) return;
    }
    try {
      submission_.mark_over(state_.words);
    } catch (const EnvironmentError&) {
      // A folder that may only be read: it is asked again next time.
    }
  }

  void ask() {
    try {
      const auto dispatcher = make_dispatcher(submission_.dispatcher);
      if (submission_.user != find_user()) {
        state_.why = "it is another user's (" + submission_.user + ")";
        return;
      }
      if (submission_.place != dispatcher->find_place()) {
        state_.why = "it was submitted to another cluster (" + submission_.place + ")";
        return;
      }
      std::map<std::string, std::string> part_of_job = find_jobs(submission_, *dispatcher), names;
      for (const auto& [job, part] : part_of_job) names[job] = submission_.job_name(part);
      const QueueAnswer answer = dispatcher->query(names);
      state_.why = answer.silence;
      if (!state_.why.empty()) return;
      for (const QueuedTasks& tasks : answer.tasks) count(tasks, part_of_job[tasks.job]);
    } catch (const EnvironmentError& e) {
      state_.why = e.what();
      return;
    }
    const bool any = state_.pending + state_.running > 0;
    state_.queue = any ? QueueState::kQueued : QueueState::kEnded;
  }

  void count(const QueuedTasks& tasks, const std::string& part) {
    const auto array = find_array(submission_, part);
    if (tasks.state == TaskState::kEnded) {
      if (array) state_.words[{*array, tasks.task}] = tasks.word;
      return;
    }
    if (tasks.state == TaskState::kPending) {
      state_.pending += tasks.count;
      state_.reasons[tasks.reason] += tasks.count;
    } else {
      state_.running += tasks.count;
    }
    if (part == Submission::kRetry) state_.retries = true;
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
    const auto word = state_.words.find({array, task});
    const TaskFate fate = judge_task(lives, submission_.is_cancelled(),
                                     word == state_.words.end() ? "" : word->second);
    ++state_.fates[fate];
  }

  const Submission& submission_;
  SubmissionState state_;
  using TaskKey = std::pair<std::size_t, std::int64_t>;
  std::set<TaskKey> live_;
  std::set<std::size_t> whole_;
};

}  // namespace

const char* get_name(QueueState state) {
  constexpr std::array<const char*, 3> kNames = {"queued", "ended", "unknown"};
  return kNames[static_cast<std::size_t>(state)];
}

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

SubmissionState follow(const Submission& submission) { return Follower(submission).follow(); }

}  // namespace strut
