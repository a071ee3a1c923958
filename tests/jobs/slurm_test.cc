// Sweeps on real Slurm daemons (slurm_cluster.h): despite all failures of tasks, the data equal
// those of a run on this machine.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "sweep/folder.h"
#include "sweep/status.h"
#include "tests/jobs/program_sweep.h"
#include "tests/jobs/slurm_cluster.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using test::Outcome;
using test::ProgramSweep;
using test::run_sweep_command;
using test::SlurmCluster;
using test::wait_until;

/// A sweep with tasks of some seconds.
const ProgramSweep& get_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(4, "", "4e-6"));
  return sweep;
}

test::JsonTree read_status(const fs::path& sweep) {
  return test::parse_json(run_sweep_command("status", sweep, "--json").out);
}

Outcome submit(const fs::path& sweep, const std::string& options = "") {
  return run_sweep_command("submit", sweep, "--to slurm --minutes 0.02 --json " + options);
}

bool has_ended(const fs::path& sweep) {
  const auto status = read_status(sweep);
  return status.get_child("submissions").back().second.get<std::string>("state") == "ended";
}

/// Lets requeued tasks start soon instead of in two minutes, but not at once, as processes of their
/// previous attempts may still be ending. Also undoes an effect of one host that serves as two
/// nodes: a task requeued from one is a "duplicate" for the other, which is drained, and the task
/// is held.
void hurry() {
  SlurmCluster::ask(
      "for job in $(squeue -h -r -t pending -o '%r|%F_%K' | sed -n 's/^BeginTime|//p'); do "
      "sleep 2; scontrol update JobId=$job StartTime=now; done; "
      "for node in $(sinfo -h -N -t drained -o %N); do "
      "scontrol update NodeName=$node State=RESUME; done; "
      "for job in $(squeue -h -r -t pending -o '%r|%F_%K' | sed -n 's/^.*held|//p'); do "
      "scontrol release $job; done");
}

std::size_t count_shards(const fs::path& sweep) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(sweep / "shards"), fs::directory_iterator()));
}

/// Waits until all tasks have ended, calling `meanwhile` repeatedly; gives up only after three
/// minutes without a new shard, however slow the machine.
bool wait_for_end(const fs::path& sweep, const std::function<void()>& meanwhile = {}) {
  bool ended = false;
  std::size_t shards = 0;
  const auto has_moved = [&] {
    if (meanwhile) meanwhile();
    hurry();
    ended = has_ended(sweep);
    return ended || count_shards(sweep) > shards;
  };
  while (!ended) {
    shards = count_shards(sweep);
    if (!wait_until(has_moved, 180.0, 500)) return false;
  }
  return true;
}

/// Returns the number of a running task of the first array of the last submission: "4711_2".
std::string find_running() {
  std::string task;
  REQUIRE(wait_until([&] {
    task = SlurmCluster::ask("squeue -h -r -t running -o %F_%K | grep -v N/A | head -n 1");
    return !task.empty();
  }));
  return task;
}

/// Returns the pattern by which pgrep finds a task of the first array, but not the calling shell.
std::string make_pattern(const fs::path& sweep, const std::string& task) {
  return "[r]un " + sweep.string() + " .*--task 001/0/" + task + "$";
}

bool is_running(const std::string& task) {
  return !SlurmCluster::ask("squeue -h -r -t running,completing -j " + task).empty();
}

TEST_CASE("A sweep on Slurm survives killed and requeued tasks", "[cluster]") {
  const SlurmCluster cluster(1, 2);
  const fs::path sweep = get_sweep().copy("killed");
  const Outcome outcome = submit(sweep, "--merge");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const std::string killed = find_running();
  const std::string number = killed.substr(killed.find('_') + 1);
  const std::string kill = "pkill -KILL -f '" + make_pattern(sweep, number) + "'";
  REQUIRE(wait_until([&] { return test::run_shell(kill).code == 0; }, 10.0));
  REQUIRE(wait_until([&] { return !is_running(killed); }));
  REQUIRE(test::run_shell("scontrol requeue " + find_running()).code == 0);
  REQUIRE(wait_for_end(sweep));
  const auto first = read_status(sweep);
  const auto& last = first.get_child("submissions").back().second;
  CHECK(last.get<int>("ended.lost") == 1);
  CHECK(last.get<int>("restarts") == 1);
  // Only the shards that the killed task had not written are missing, and the next submission
  // queues just those.
  CHECK_FALSE(first.get<bool>("complete"));
  REQUIRE(submit(sweep, "--merge").code == 0);
  REQUIRE(wait_for_end(sweep));
  CHECK(read_status(sweep).get<bool>("complete"));
  get_sweep().check_whole(sweep);
  CHECK(fs::exists(sweep / "merged.h5"));
}

TEST_CASE("A task warned of its time limit continues in its next attempt", "[cluster]") {
  const SlurmCluster cluster(1);
  const fs::path sweep = get_sweep().copy("warned");
  REQUIRE(submit(sweep, "--tasks 1").code == 0);
  REQUIRE(wait_until([&] { return !fs::is_empty(sweep / "shards"); }));
  // The signal that Slurm sends before the limit, by --signal.
  SlurmCluster::ask("scancel --signal=USR1 --batch " + find_running());
  REQUIRE(wait_for_end(sweep));
  INFO(test::read_text(sweep / "jobs/001/array-0/0")
       << SlurmCluster::ask("cat " + (sweep / "logs").string() + "/*"));
  const auto status = read_status(sweep);
  CHECK(status.get<bool>("complete"));
  const auto& last = status.get_child("submissions").back().second;
  CHECK(last.get<int>("restarts") == 1);
  CHECK(last.get<int>("ended.done") == 1);
  get_sweep().check_whole(sweep);
}

TEST_CASE("Slurm warns a task of its time limit", "[cluster][slow]") {
  const SlurmCluster cluster(1);
  static const ProgramSweep slow(test::make_coarse_sweep(4, "", "1e-6"));
  const fs::path sweep = slow.copy("slow");
  // One minute, of which the warning leaves ten seconds or, since Slurm checks rarely, none; the
  // second attempt may take as long as it needs.
  REQUIRE(submit(sweep, "--tasks 1 --option=--time=1 --option=--signal=B:USR1@50").code == 0);
  const auto read_submission = [&] {
    return read_status(sweep).get_child("submissions").back().second;
  };
  const auto raise_limit = [&] {
    if (read_submission().get<int>("restarts") == 0) return;
    SlurmCluster::ask(
        "for job in $(squeue -h -r -o %F_%K | grep -v N/A); do "
        "scontrol update JobId=$job TimeLimit=60; done");
  };
  REQUIRE(wait_for_end(sweep, raise_limit));
  const auto last = read_submission();
  CHECK(last.get<int>("restarts") >= 1);
  CHECK(last.get<int>("ended.timeout", 0) == 0);
  if (!read_status(sweep).get<bool>("complete")) {
    REQUIRE(submit(sweep, "--tasks 1").code == 0);
    REQUIRE(wait_for_end(sweep));
  }
  slow.check_whole(sweep);
}

TEST_CASE("A timed-out task is distinguished from a failed one", "[cluster][slow]") {
  const SlurmCluster cluster(1);
  const fs::path sweep = get_sweep().copy("timeout");
  // Slurm counts in minutes. This task hangs, as on a file system that does not answer: it is
  // stopped again whenever it continues.
  REQUIRE(submit(sweep, "--tasks 2 --option=--time=1 --option=--signal=B:URG@1").code == 0);
  REQUIRE(wait_until([&] { return fs::exists(sweep / "jobs/001/array-0/0"); }));
  const std::string stop = "pkill -STOP -f '" + make_pattern(sweep, "0") + "'";
  REQUIRE(test::run_shell(stop).code == 0);
  REQUIRE(wait_for_end(sweep, [&] { test::run_shell(stop); }));
  const auto last = read_status(sweep).get_child("submissions").back().second;
  INFO(test::read_text(sweep / "jobs/001/array-0/0"));
  CHECK(last.get<int>("ended.timeout") == 1);
  CHECK(last.get<int>("ended.done") == 1);
  REQUIRE(submit(sweep).code == 0);
  REQUIRE(wait_for_end(sweep));
  get_sweep().check_whole(sweep);
}

TEST_CASE("A billion cases are queued as arrays without being listed", "[cluster]") {
  const SlurmCluster cluster(1);
  std::string text = test::make_coarse_sweep(65536);
  const std::size_t grid = text.find("[grid]\n") + 7;
  text.replace(grid, text.find("[sample]") - grid,
               "front_stiffness = { from = 40000, to = 30010, step = -10 }\n"
               "front_damping = { from = 1980, to = 981, step = -1 }\n"
               "rear_stiffness = { from = 35000, to = 25010, step = -10 }\n");
  const fs::path request = get_sweep() / "large.toml", sweep = get_sweep() / "large";
  std::ofstream(request) << text;
  REQUIRE(test::run_program("plan " + request.string() + " -o " + sweep.string()).code == 0);
  // The numbers of the cases alone would take 8 GB. Tasks of a minute are more than two arrays,
  // however fast the machine.
  const Outcome outcome = test::run_shell("(ulimit -v 2000000; " STRUT_PROGRAM " submit " +
                                          sweep.string() + " --to slurm --minutes 1 --json)");
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const auto submitted = test::parse_json(outcome.out);
  CHECK(submitted.get<int>("tasks") > 1000);
  CHECK(submitted.get_child("jobs").size() > 2);
  CHECK(SlurmCluster::count_tasks("pending,running") > 1000);
  CHECK(run_sweep_command("cancel", sweep).code == 0);
}

TEST_CASE("A sweep on two nodes survives the loss of its scheduler and of a node", "[cluster]") {
  SlurmCluster cluster(2);
  const fs::path sweep = get_sweep().copy("two");
  REQUIRE(submit(sweep).code == 0);
  // However fast the machine, no task ends before its node does. Only tasks that have recorded
  // their start are stopped.
  const fs::path records = sweep / "jobs/001/array-0";
  const auto signal_tasks = [&](const std::string& signal) {
    if (!fs::exists(records)) return;
    for (const fs::directory_entry& record : fs::directory_iterator(records)) {
      const std::string task = record.path().filename();
      test::run_shell("pkill -" + signal + " -f '" + make_pattern(sweep, task) + "'");
    }
  };
  const auto runs_on_second_node = [&] {
    signal_tasks("STOP");
    const std::string task = SlurmCluster::ask("squeue -h -r -t running -w n2 -o %K");
    return !task.empty() && fs::exists(records / task);
  };
  REQUIRE(wait_until(runs_on_second_node));
  REQUIRE(cluster.wait_until_saved());
  signal_tasks("STOP");
  cluster.kill_controller();
  // The state is unknown: that is neither the end nor a reason to queue tasks again.
  const auto silent = read_status(sweep).get_child("submissions").back().second;
  CHECK(silent.get<std::string>("state") == "unknown");
  const Outcome refused = submit(sweep);
  CHECK(refused.code == 3);
  cluster.start_controller();
  REQUIRE(wait_until(runs_on_second_node));
  REQUIRE(test::run_shell("scontrol update NodeName=n2 State=DOWN Reason=test >/dev/null").code ==
          0);
  signal_tasks("CONT");
  REQUIRE(wait_for_end(sweep));
  // The scheduler requeued the tasks of that node by itself.
  const auto ended = read_status(sweep);
  CHECK(ended.get_child("submissions").back().second.get<int>("restarts") >= 1);
  CHECK(ended.get<bool>("complete"));
  get_sweep().check_whole(sweep);
}

TEST_CASE("Of the nodes' time, the scheduler costs the paper's grid less than 2 %",
          "[cluster][statistical][slow]") {
  const SlurmCluster cluster(2);
  const fs::path sweep = get_sweep() / "paper";
  REQUIRE(
      test::run_program("plan " STRUT_SOURCE_DIR "/examples/sweeps/paper.toml -o " + sweep.string())
          .code == 0);
  REQUIRE(run_sweep_command("submit", sweep, "--to slurm --minutes 0.6").code == 0);
  REQUIRE(wait_for_end(sweep));
  REQUIRE(read_status(sweep).get<bool>("complete"));
  const SweepFolder folder{sweep};
  const double simulated = read_status(folder, open_sweep_folder(folder)).simulation_seconds;
  const double given = cluster.calc_node_time();
  WARN("simulated " << simulated << " s of " << given << " s given, overhead "
                    << 100.0 * (1.0 - simulated / given) << " %");
  CHECK(given - simulated < test::tolerance(0.02) * given);
  CHECK(given > simulated);
}

TEST_CASE("Submissions that Slurm would refuse fail before anything is queued", "[cluster]") {
  const SlurmCluster cluster(1);
  const fs::path sweep = get_sweep().copy("refused");
  const Outcome partition = submit(sweep, "--partition nowhere");
  CHECK(partition.code == 2);
  CHECK_THAT(partition.messages, Contains("nowhere") && Contains("test"));
  const Outcome constraint = submit(sweep, "--constraint gpu_of_tomorrow");
  CHECK(constraint.code == 3);
  CHECK_THAT(constraint.messages, Contains("feature"));
  // A time limit shorter than a shard and the warning before it; a folder that nodes cannot see.
  const Outcome walltime = submit(sweep, "--time 1");
  CHECK(walltime.code == 2);
  CHECK_THAT(walltime.messages,
             Contains("--time 1 min 0 s: must be at least 2 min") && Contains("one shard takes"));
  const Outcome folder = submit(sweep, "--partition far");
  CHECK(folder.code == 2);
  CHECK_THAT(folder.messages,
             Contains(sweep.string()) && Contains("far") && Contains("cannot see"));
  const Outcome doctor = run_sweep_command("doctor", sweep, "--to slurm --nodes");
  CHECK(doctor.code == 0);
  CHECK_THAT(doctor.out, Contains("instruction sets of the nodes: n1: ") && Contains("job arrays"));
  const Outcome dry = run_sweep_command("submit", sweep, "--to slurm --merge --dry-run");
  CHECK(dry.code == 0);
  CHECK_THAT(dry.out, Contains("$ sbatch --parsable --job-name=strut-") && !Contains("#SBATCH") &&
                          Contains("--dependency=afterany:array-0"));
  CHECK(SlurmCluster::count_tasks("pending,running") == 0);
  CHECK_FALSE(fs::exists(sweep / "jobs"));
}

TEST_CASE("A sweep on Slurm is cancelled from its folder", "[cluster]") {
  const SlurmCluster cluster(1);
  const fs::path sweep = get_sweep().copy("cancelled");
  REQUIRE(submit(sweep).code == 0);
  find_running();
  const Outcome outcome = run_sweep_command("cancel", sweep);
  CHECK(outcome.code == 0);
  REQUIRE(wait_until([&] { return SlurmCluster::count_tasks("pending,running") == 0; }));
  CHECK(test::verify_by_program(sweep).damaged.empty());
  const auto last = read_status(sweep).get_child("submissions").back().second;
  CHECK(last.get<bool>("cancelled"));
  CHECK(wait_for_end(sweep));
}

}  // namespace
}  // namespace strut
