// Sweeps on real Slurm daemons (slurm_cluster.h): whatever befalls the tasks, the data are those of
// a run on this machine.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/program_sweep.h"
#include "tests/slurm_cluster.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using test::Outcome;
using test::ProgramSweep;
using test::run_sweep_command;
using test::SlurmCluster;
using test::wait_until;

/// Tasks of some seconds.
const ProgramSweep& get_sweep() {
  static const ProgramSweep sweep(test::make_coarse_sweep(4, "", "2e-5"));
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

/// Once all tasks have ended. Slurm lets those that it puts back wait for two minutes; not here.
bool wait_for_end(const fs::path& sweep) {
  return wait_until(
      [&] {
        SlurmCluster::ask(
            "for job in $(squeue -h -r -t pending -o '%r %F_%K' | sed -n 's/^BeginTime //p'); do "
            "scontrol update JobId=$job StartTime=now; done");
        return has_ended(sweep);
      },
      180.0);
}

/// The number of a task of the last submission's first array that runs: "4711_2".
std::string find_running() {
  std::string task;
  REQUIRE(wait_until([&] {
    task = SlurmCluster::ask("squeue -h -r -t running -o %F_%K | grep -v N/A | head -n 1");
    return !task.empty();
  }));
  return task;
}

TEST_CASE("A sweep on Slurm outlives tasks that are killed and put back", "[cluster]") {
  const SlurmCluster cluster(1, 2);
  const fs::path sweep = get_sweep().copy("killed");
  const Outcome outcome = submit(sweep);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  SlurmCluster::ask("scancel --signal=KILL --full " + find_running());
  const std::string requeued = find_running();
  SlurmCluster::ask("scontrol requeue " + requeued);
  REQUIRE(wait_for_end(sweep));
  // What the killed task had not written is missing, and all that another submission queues.
  if (!read_status(sweep).get<bool>("complete")) {
    REQUIRE(submit(sweep).code == 0);
    REQUIRE(wait_for_end(sweep));
  }
  CHECK(read_status(sweep).get<bool>("complete"));
  get_sweep().check_whole(sweep);
  CHECK(fs::exists(sweep / "merged.h5"));
}

TEST_CASE("A sweep on two nodes outlives its scheduler and a node", "[cluster]") {
  SlurmCluster cluster(2);
  const fs::path sweep = get_sweep().copy("two");
  REQUIRE(submit(sweep).code == 0);
  find_running();
  cluster.kill_controller();
  // Nobody knows: that is neither the end nor a reason to queue anything anew.
  const auto silent = read_status(sweep).get_child("submissions").back().second;
  CHECK(silent.get<std::string>("state") == "unknown");
  const Outcome refused = submit(sweep);
  CHECK(refused.code == 3);
  cluster.start_controller();
  find_running();
  SlurmCluster::ask("scontrol update NodeName=n2 State=DOWN Reason=test");
  REQUIRE(wait_until([&] { return SlurmCluster::count_nodes("down") == 1; }));
  REQUIRE(wait_for_end(sweep));
  if (!read_status(sweep).get<bool>("complete")) {
    REQUIRE(submit(sweep).code == 0);
    REQUIRE(wait_for_end(sweep));
  }
  get_sweep().check_whole(sweep);
}

TEST_CASE("Slurm is asked before anything is queued", "[cluster]") {
  const SlurmCluster cluster(1);
  const fs::path sweep = get_sweep().copy("refused");
  const Outcome partition = submit(sweep, "--partition nowhere");
  CHECK(partition.code == 2);
  CHECK_THAT(partition.messages, Contains("nowhere") && Contains("test"));
  const Outcome constraint = submit(sweep, "--constraint gpu_of_tomorrow");
  CHECK(constraint.code == 3);
  CHECK_THAT(constraint.messages, Contains("feature"));
  const Outcome dry = submit(sweep, "--dry-run");
  CHECK(dry.code == 0);
  CHECK_THAT(dry.out, Contains("#SBATCH") && Contains("afterany"));
  CHECK(SlurmCluster::count_tasks("all") == 0);
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
