#include "cluster/follow.h"

#include <array>
#include <set>

#include "base/error/input_error.h"

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
      if (submission_.read_job(part).job.empty()) return;
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
      const std::vector<JobRecord> jobs = find_jobs(submission_, *dispatcher);
      std::map<std::string, std::string> part_of_job;
      for (const JobRecord& record : jobs) part_of_job[record.job] = record.part;
      const QueueAnswer answer = dispatcher->query(jobs);
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
    const Folder folder = submission_.open();
    is_cancelled_ = submission_.is_cancelled();
    for (std::size_t a = 0; a < submission_.arrays.size(); ++a) {
      const auto array = folder.find_folder(submission_.array_name(a));
      for (std::int64_t t = 0; t < submission_.arrays[a].tasks(); ++t) {
        read_task(a, t,
                  array ? read_task_lives(*array, std::to_string(t)) : std::vector<TaskLife>());
      }
    }
  }

  void read_task(std::size_t array, std::int64_t task, const std::vector<TaskLife>& lives) {
    if (lives.size() > 1) state_.restarts += static_cast<std::int64_t>(lives.size()) - 1;
    if (live_.count({array, task}) > 0) return;
    // Of a job that has no numbers for its tasks, those that have not ended are live.
    if (whole_.count(array) > 0 && (lives.empty() || !lives.back().how)) return;
    const auto word = state_.words.find({array, task});
    const TaskFate fate =
        judge_task(lives, is_cancelled_, word == state_.words.end() ? "" : word->second);
    ++state_.fates[fate];
  }

  const Submission& submission_;
  SubmissionState state_;
  bool is_cancelled_ = false;
  using TaskKey = std::pair<std::size_t, std::int64_t>;
  std::set<TaskKey> live_;
  std::set<std::size_t> whole_;
};

}  // namespace

const char* get_name(QueueState state) {
  constexpr std::array<const char*, 3> kNames = {"queued", "ended", "unknown"};
  return kNames[static_cast<std::size_t>(state)];
}

std::vector<JobRecord> find_jobs(const Submission& submission, const Dispatcher& dispatcher) {
  std::vector<JobRecord> jobs;
  for (const std::string& part : submission.list_parts()) {
    JobRecord record = submission.read_job(part);
    if (record.job.empty()) record.job = dispatcher.find_job(record);
    if (!record.job.empty()) jobs.push_back(std::move(record));
  }
  return jobs;
}

SubmissionState follow(const Submission& submission) { return Follower(submission).follow(); }

}  // namespace strut
