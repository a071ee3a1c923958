// Tasks of a submission: their shards, their records, and how they are judged.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "cluster/follow.h"
#include "cluster/slurm.h"
#include "cluster/task_run.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Ranges = std::vector<ShardRange>;

PackingRequest make_request(std::int64_t array_tasks, std::int64_t tasks) {
  PackingRequest request;
  request.shard_seconds = 60.0;
  request.limits.array_tasks = array_tasks;
  request.limits.tasks = tasks;
  return request;
}

TEST_CASE("Missing shards are listed as ranges", "[unit]") {
  CHECK(list_missing(10, {}) == Ranges{{0, 10}});
  CHECK(list_missing(10, {0, 3, 4, 9}) == Ranges{{1, 3}, {5, 9}});
  CHECK(list_missing(10, {3}, {{5, 12}}) == Ranges{{0, 3}, {4, 5}});
  CHECK(list_missing(3, {0, 1, 2}).empty());
}

TEST_CASE("Tasks cover each missing shard once, within the limits of a site", "[unit][property]") {
  std::mt19937 draw(7);
  for (int trial = 0; trial < 50; ++trial) {
    const auto shards = static_cast<std::int64_t>(1 + draw() % 400);
    std::vector<std::int64_t> present;
    for (std::int64_t s = 0; s < shards; ++s) {
      if (draw() % 3 == 0) present.push_back(s);
    }
    const Ranges missing = list_missing(shards, present);
    const auto array_tasks = static_cast<std::int64_t>(1 + draw() % 9);
    const auto tasks = static_cast<std::int64_t>(1 + draw() % 40);
    std::vector<int> covered(static_cast<std::size_t>(shards), 0);
    std::int64_t total = 0;
    for (const PackedArray& array : pack_shards(missing, make_request(array_tasks, tasks))) {
      CHECK(array.tasks() <= array_tasks);
      total += array.tasks();
      for (std::int64_t t = 0; t < array.tasks(); ++t) {
        const ShardRange range = array.get_task(t);
        CHECK(range.count() > 0);
        for (std::int64_t s = range.first; s < range.end; ++s) {
          ++covered[static_cast<std::size_t>(s)];
        }
      }
    }
    CHECK(total <= tasks);
    for (const ShardRange& range : missing) {
      for (std::int64_t s = range.first; s < range.end; ++s) {
        CHECK(covered[static_cast<std::size_t>(s)] == 1);
      }
    }
  }
}

TEST_CASE("A task has the target duration", "[unit]") {
  // A shard takes one minute, a task ten.
  const auto arrays = pack_shards({{0, 35}}, make_request(1000, 1000));
  REQUIRE(arrays.size() == 1);
  CHECK(arrays[0].shards_per_task == 10);
  CHECK(arrays[0].tasks() == 4);
  CHECK(arrays[0].get_task(3) == ShardRange{30, 35});
}

TEST_CASE("Two million shards are packed without being listed", "[unit]") {
  const auto arrays = pack_shards({{0, 2'000'000}}, make_request(1001, 1'000'000));
  CHECK(arrays.size() == 200);
  CHECK(arrays.back().shards.end == 2'000'000);
}

TEST_CASE("Durations of Slurm are parsed and formatted", "[unit]") {
  CHECK(*parse_slurm_time("5") == 300.0);
  CHECK(*parse_slurm_time("04:05") == 245.0);
  CHECK(*parse_slurm_time("03:04:05") == 11045.0);
  CHECK(*parse_slurm_time("2-03:04:05") == 183845.0);
  CHECK(*parse_slurm_time("1-12") == 129600.0);
  CHECK(std::isinf(*parse_slurm_time("infinite")));
  for (const char* text : {"", "soon", "1:2:3:4", "-5", "1-", "5 min"}) {
    INFO(text);
    CHECK_FALSE(parse_slurm_time(text));
  }
  CHECK(format_slurm_time(183845.0) == "2-03:05:00");
  CHECK(format_slurm_time(60.0) == "0-00:01:00");
}

TaskAttempt make_attempt(std::optional<TaskOutcome> outcome, std::int64_t limit = 0) {
  return {"node", 1000, limit, 0, outcome, outcome ? 2000 : 0, 3};
}

TEST_CASE("The fate of a task follows from its last attempt", "[unit]") {
  CHECK(judge_task({}, false) == TaskFate::kNeverStarted);
  CHECK(judge_task({}, true) == TaskFate::kCancelled);
  CHECK(judge_task({make_attempt(TaskOutcome::kDone)}, true) == TaskFate::kDone);
  CHECK(judge_task({make_attempt(TaskOutcome::kFailed)}, false) == TaskFate::kFailed);
  CHECK(judge_task({make_attempt(TaskOutcome::kError)}, false) == TaskFate::kError);
  CHECK(judge_task({make_attempt(TaskOutcome::kDrained)}, false) == TaskFate::kDrained);
  CHECK(judge_task({make_attempt(TaskOutcome::kDrained), make_attempt(TaskOutcome::kDone)},
                   false) == TaskFate::kDone);
  // Stopped at its time limit; long before; by `strut cancel`.
  CHECK(judge_task({make_attempt(TaskOutcome::kStopped, 2003)}, false) == TaskFate::kTimeout);
  CHECK(judge_task({make_attempt(TaskOutcome::kStopped, 9000)}, false) == TaskFate::kPreempted);
  CHECK(judge_task({make_attempt(TaskOutcome::kStopped, 9000)}, true) == TaskFate::kCancelled);
  CHECK(judge_task({make_attempt(std::nullopt)}, false) == TaskFate::kLost);
  // Without a recorded outcome, the scheduler's state decides.
  CHECK(judge_task({make_attempt(std::nullopt)}, false, "TIMEOUT") == TaskFate::kTimeout);
  CHECK(judge_task({make_attempt(TaskOutcome::kStopped, 9000)}, false, "CANCELLED") ==
        TaskFate::kCancelled);
  CHECK(judge_task({make_attempt(TaskOutcome::kDone)}, false, "CANCELLED") == TaskFate::kDone);
  CHECK(judge_task({}, false, "FAILED") == TaskFate::kLost);
}

TEST_CASE("A submission reads back as it was written", "[io]") {
  const test::TemporaryFolder folder;
  const SweepFolder sweep{folder / "."};
  CHECK(list_submissions(sweep).empty());
  const std::vector<PackedArray> arrays = {{{0, 100}, 7}, {{200, 201}, 7}};
  const Submission first =
      make_submission(sweep, {"", "slurm", "ours", "", "strut-abc", arrays, true, true});
  make_submission(sweep, {"", "local", "", "", "strut-abc", {{{5, 6}, 1}}});
  first.write_job("array-1", "4711");
  first.mark_cancelled();

  const std::vector<Submission> all = list_submissions(sweep);
  REQUIRE(all.size() == 2);
  CHECK(all[0].name() == "001");
  CHECK(all[0].dispatcher == "slurm");
  CHECK(all[0].cluster_name == "ours");
  CHECK(all[0].user == find_user());
  CHECK(all[0].job_name("collect") == first.job_prefix + ".collect");
  // A copy of the folder has submissions of its own.
  CHECK(first.job_prefix != all[1].job_prefix);
  CHECK(all[0].arrays == arrays);
  CHECK(all[0].list_parts() == std::vector<std::string>{"array-0", "array-1", "retry", "collect"});
  CHECK(all[0].read_job("array-0").job.empty());
  CHECK(all[0].read_job("array-1").job == "4711");
  CHECK(all[0].is_cancelled());
  CHECK_FALSE(all[0].is_finished());
  CHECK(all[1].name() == "002");
  CHECK(all[1].list_parts() == std::vector<std::string>{"array-0"});

  folder.write("jobs/001/submission.toml", "dispatcher = 3\n");
  CHECK_THROWS_AS(list_submissions(sweep), InputError);
  std::vector<std::string> faults;
  CHECK(list_submissions(sweep, &faults).size() == 1);
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].find("dispatcher") != std::string::npos);
}

/// Commands of a Slurm with answers that the test sets.
class SaidSlurm {
 public:
  SaidSlurm() : path_(std::getenv("PATH")) {
    say("squeue", "");
    say("scontrol",
        "[[ $2 == config ]] && echo 'ClusterName = ours' && exit\n"
        "echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1");
    ::setenv("PATH", ((folder_ / "").string() + ":" + path_).c_str(), 1);
  }
  ~SaidSlurm() { ::setenv("PATH", path_.c_str(), 1); }
  SaidSlurm(const SaidSlurm&) = delete;
  SaidSlurm& operator=(const SaidSlurm&) = delete;

  void say(const std::string& command, const std::string& script) const {
    const auto file = folder_.write(command, "#!/bin/bash\n" + script + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }

 private:
  std::string path_;
  test::TemporaryFolder folder_;
};

TEST_CASE("An empty queue does not mean the end, and only this user and cluster are asked",
          "[unit]") {
  const SaidSlurm slurm;
  const test::TemporaryFolder folder;
  const SweepFolder sweep{folder / "."};
  const auto queue = [&](const std::string& place) {
    Submission s = make_submission(sweep, {"", "slurm", place, "", "strut", {{{0, 10}, 5}}});
    s.write_job("array-0", "4711");
    return s;
  };
  const Submission ended = queue("ours");
  const std::string mark = make_job_mark(sweep.root, ended.job_name("array-0"));
  const std::string name = "|" + mark + "|" + ended.job_name("array-0") + "'";
  slurm.say("squeue",
            "echo '4711|0|RUNNING|None" + name + "; echo '4711|1|PENDING|Resources" + name);
  const SubmissionState running = follow(ended);
  CHECK(running.queue == QueueState::kQueued);
  CHECK(running.running == 1);
  CHECK(running.queued_shards == Ranges{{0, 5}, {5, 10}});
  // A job of a copied folder: whether this folder's job runs is unknown, and nothing is stopped.
  slurm.say("squeue", "echo '4711|0|RUNNING|None|0123|" + ended.job_name("array-0") + "'");
  slurm.say("scancel", "touch " + (folder / "cancelled").string());
  const SubmissionState copied = follow(ended);
  CHECK(copied.queue == QueueState::kUnknown);
  CHECK(copied.why_unknown.find("copied") != std::string::npos);
  CHECK_THROWS_AS(SlurmDispatcher().cancel({ended.read_job("array-0")}), EnvironmentError);
  CHECK(SlurmDispatcher().find_job(ended.read_job("array-0")).empty());
  CHECK_FALSE(std::filesystem::exists(folder / "cancelled"));
  // Environment variables that would hide parts of the answer are not passed to the command.
  slurm.say("squeue", "[[ -z ${SQUEUE_PARTITION:-} ]] && echo '4711|0|RUNNING|None" + name);
  ::setenv("SQUEUE_PARTITION", "x", 1);
  CHECK(follow(ended).queue == QueueState::kQueued);
  ::unsetenv("SQUEUE_PARTITION");
  // Not listed, but the controller still knows the job or gives no answer.
  slurm.say("squeue", "");
  const std::string config = "[[ $2 == config ]] && echo 'ClusterName = ours' && exit\n";
  const std::string known =
      "echo 'JobId=4711 JobName=" + ended.job_name("array-0") + " Comment=" + mark + " '";
  for (const std::string& script : {known, std::string("echo 'Unable to contact' >&2; exit 1")}) {
    INFO(script);
    slurm.say("scontrol", config + script);
    const SubmissionState state = follow(ended);
    CHECK(state.queue == QueueState::kUnknown);
    CHECK(state.why_unknown.find("4711") != std::string::npos);
    CHECK_FALSE(ended.is_finished());
  }
  // The final states of an ended submission outlive the scheduler's memory.
  slurm.say("scontrol", config + "echo 'Invalid job id specified' >&2; exit 1");
  slurm.say("squeue", "echo '4711|0|TIMEOUT|TimeLimit" + name);
  CHECK(follow(ended).fates.at(TaskFate::kTimeout) == 1);
  REQUIRE(ended.is_finished());
  slurm.say("squeue", "");
  CHECK(follow(ended).fates.at(TaskFate::kTimeout) == 1);

  // A number that the scheduler has reused for another job.
  const Submission lost = queue("ours");
  slurm.say("squeue", "echo '4711|0|RUNNING|None||other'");
  slurm.say("scontrol", config + "echo 'JobId=4711 JobName=other'");
  CHECK(follow(lost).queue == QueueState::kEnded);

  const SubmissionState elsewhere = follow(queue("theirs"));
  CHECK(elsewhere.queue == QueueState::kUnknown);
  CHECK(elsewhere.why_unknown.find("theirs") != std::string::npos);
  Submission foreign = queue("ours");
  foreign.user = "4711";
  CHECK(follow(foreign).queue == QueueState::kUnknown);
}

TEST_CASE("A task knows its shards and records its attempts", "[io]") {
  const test::TemporaryFolder folder;
  const SweepFolder sweep{folder / "."};
  const Submission s = make_submission(sweep, {"", "local", "", "", "strut", {{{10, 35}, 10}}});
  TaskRun task(sweep, make_task_name("001", 0, "2"), 35);
  CHECK(task.shards() == ShardRange{30, 35});
  task.begin();
  const Folder array = s.open().open_folder("array-0");
  REQUIRE(read_task_attempts(array, "2").size() == 1);
  CHECK_FALSE(read_task_attempts(array, "2")[0].outcome);
  task.end(TaskOutcome::kDrained, 0);
  CHECK(task.requeue().find("cannot put it back into the queue") != std::string::npos);
  TaskRun second(sweep, "001/0/2", 35);
  second.begin();
  second.end(TaskOutcome::kDrained, 0);
  CHECK(second.requeue().find("longer --time") != std::string::npos);
  TaskRun again(sweep, "001/0/2", 35);
  again.begin();
  again.end(TaskOutcome::kDone, 5);
  const std::vector<TaskAttempt> attempts = read_task_attempts(array, "2");
  REQUIRE(attempts.size() == 3);
  CHECK(attempts[0].outcome == TaskOutcome::kDrained);
  CHECK(attempts[2].outcome == TaskOutcome::kDone);
  CHECK(attempts[2].shards == 5);

  for (const char* name : {"001/0/3", "001/1/0", "002/0/0", "001/0", "001/0/x"}) {
    INFO(name);
    CHECK_THROWS_AS(TaskRun(sweep, name, 35), InputError);
  }
  // A submission of a larger sweep.
  CHECK_THROWS_AS(TaskRun(sweep, "001/0/0", 34), InputError);
  folder.write("jobs/001/array-0/2", "no life\n");
  CHECK_THROWS_AS(read_task_attempts(array, "2"), InputError);
}

}  // namespace
}  // namespace strut
