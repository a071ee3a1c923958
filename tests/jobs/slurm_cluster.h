// A Slurm cluster of the test: real daemons on one machine as several nodes, in a folder, with
// their own ports and key. Nothing of the machine's own Slurm is read or changed.
#pragma once

#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/run_shell.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

/// Returns whether the condition came true in time; polls it.
inline bool wait_until(const std::function<bool()>& happened, double seconds = 30.0,
                       int milliseconds = 50) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(seconds));
  while (!happened()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  }
  return true;
}

class SlurmCluster {
 public:
  /// Starts nodes n1, n2, ... with `processors` each. Shells of this process use this cluster.
  explicit SlurmCluster(int nodes, int processors = 1) : nodes_(nodes) {
    for (const char* name : {"state", "log", "munge", "socket"}) {
      std::filesystem::create_directory(path(name));
    }
    run("chmod 755 " + path("") + " " + path("socket") + "; chmod 700 " + path("munge") +
        "; head -c 1024 /dev/urandom > " + path("munge/key") + "; chmod 600 " + path("munge/key"));
    write_configuration(processors);
    ::setenv("SLURM_CONF", path("slurm.conf").c_str(), 1);
    watch();
    start("munged --force --key-file=" + path("munge/key") + " --socket=" + path("socket/munge") +
          " --pid-file=" + path("munged.pid") + " --log-file=" + path("munge/log") +
          " --seed-file=" + path("munge/seed"));
    start_controller();
    for (int i = 1; i <= nodes_; ++i) start("slurmd -N n" + std::to_string(i));
    const bool idle = wait_until([&] { return count_nodes("idle") == nodes_; });
    INFO(read_text(path("log/controller")));
    if (!idle) stop();  // no destructor after a constructor that throws
    REQUIRE(idle);
  }
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;
  ~SlurmCluster() { stop(); }

  void start_controller() { start("slurmctld"); }
  /// Waits until the controller has saved the state of its jobs, which it does some seconds after a
  /// change: what it loses after that is not strut's fault.
  bool wait_until_saved() {
    const std::string file = path("state/job_state");
    const auto when = [&] {
      std::error_code missing;
      return std::filesystem::last_write_time(file, missing);
    };
    const auto before = when();
    ask("scontrol update JobId=$(squeue -h -o %F | head -n 1) Requeue=1");
    return wait_until([&] { return when() != before; });
  }
  /// Kills it, as if its machine had lost power.
  void kill_controller() {
    run("kill -9 $(cat " + path("controller.pid") + ")");
    std::filesystem::remove(path("controller.pid"));
  }

  /// Returns the time for which nodes were allocated to jobs, from their daemons' logs [s].
  double calc_node_time() const {
    double total = 0.0;
    for (int i = 1; i <= nodes_; ++i) {
      std::istringstream log(read_text(path("log/n" + std::to_string(i))));
      for (std::string line; std::getline(log, line);) {
        // [2026-11-22T20:36:02.332]
        std::tm day{};
        double seconds = 0.0;
        if (std::sscanf(line.c_str(), "[%d-%d-%dT%d:%d:%lf]", &day.tm_year, &day.tm_mon,
                        &day.tm_mday, &day.tm_hour, &day.tm_min, &seconds) != 6) {
          continue;
        }
        day.tm_year -= 1900;
        --day.tm_mon;
        const double time = static_cast<double>(::timegm(&day)) + seconds;
        if (line.find("Launching batch job") != std::string::npos) total -= time;
        if (line.find("] done with job") != std::string::npos) total += time;
      }
    }
    return total;
  }

  /// Returns the output of a command without the last line end; "" if it fails.
  static std::string ask(const std::string& command) {
    const Outcome outcome = run_shell(command);
    if (outcome.code != 0) return "";
    return outcome.out.substr(0, outcome.out.find_last_not_of('\n') + 1);
  }
  static int count_nodes(const std::string& state) {
    return std::atoi(ask("sinfo -h -N -o %T | grep -c '^" + state + "$'; true").c_str());
  }
  static int count_tasks(const std::string& state) {
    return std::atoi(ask("squeue -h -r -t " + state + " | wc -l").c_str());
  }

 private:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static void run(const std::string& command) { run_shell(command); }

  std::vector<std::string> list_process_files() const {
    std::vector<std::string> files = {path("controller.pid"), path("munged.pid")};
    for (int i = 1; i <= nodes_; ++i) files.insert(files.begin(), path("n" + std::to_string(i)));
    return files;
  }

  void stop() {
    ask("scancel --user=$(id -un)");
    wait_until([&] { return ask("squeue -h -t running,completing").empty(); }, 10.0);
    const std::vector<std::string> files = list_process_files();
    // PID 1 of a container may not reap processes: ended daemons are recognized by their files.
    for (const std::string& file : files) run("kill $(cat " + file + ") 2>/dev/null");
    wait_until([&] {
      return std::none_of(files.begin(), files.end(),
                          [](const std::string& f) { return std::filesystem::exists(f); });
    });
    ::unsetenv("SLURM_CONF");
  }

  /// Ends the daemons if the test is killed.
  void watch() {
    std::string command = "setsid sh -c 'while kill -0 " + std::to_string(::getpid()) +
                          " 2>/dev/null; do sleep 1; done; kill";
    for (const std::string& file : list_process_files()) command += " $(cat " + file + ")";
    run("(" + command + "' >/dev/null 2>&1 &)");
  }

  static void start(const std::string& command) {
    const Outcome outcome = run_shell("PATH=$PATH:/usr/sbin " + command + " >/dev/null");
    INFO(command << ": " << outcome.messages);
    REQUIRE(outcome.code == 0);
  }

  void write_configuration(int processors) {
    // Distinct for tests that run at once, and below the ports that the system assigns.
    const int port = 20000 + (static_cast<int>(::getpid()) % 1200) * 10;
    const std::string last = std::to_string(nodes_);
    const std::string names = nodes_ == 1 ? "n1" : "n[1-" + last + "]";
    const std::string ports =
        nodes_ == 1 ? std::to_string(port + 1)
                    : "[" + std::to_string(port + 1) + "-" + std::to_string(port + nodes_) + "]";
    folder_.write(
        "slurm.conf",
        "ClusterName=test\nSlurmctldHost=" + ask("hostname -s") + "\nSlurmUser=" + ask("id -un") +
            "\nSlurmdUser=" + ask("id -un") + "\nAuthType=auth/munge\nAuthInfo=socket=" +
            path("socket/munge") + "\nCredType=cred/munge\nSlurmctldPort=" + std::to_string(port) +
            "\nStateSaveLocation=" + path("state") + "\nSlurmdSpoolDir=" + path("spool-%n") +
            "\nSlurmctldPidFile=" + path("controller.pid") + "\nSlurmdPidFile=" + path("%n") +
            "\nSlurmctldLogFile=" + path("log/controller") + "\nSlurmdLogFile=" + path("log/%n") +
            R"(
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
JobRequeue=1
KillWait=2
MinJobAge=300
MaxArraySize=1001
)" +
            "NodeName=" + names + " NodeHostname=" + ask("hostname -s") +
            " NodeAddr=127.0.0.1 Port=" + ports + " CPUs=" + std::to_string(processors) +
            " RealMemory=1000 State=UNKNOWN\nPartitionName=test Nodes=" + names +
            " Default=YES MaxTime=INFINITE State=UP\n" +
            // On another machine; only the entry is needed.
            "NodeName=far NodeAddr=127.0.0.1 Port=" + std::to_string(port + 9) +
            " State=DOWN\nPartitionName=far Nodes=far State=UP\n");
  }

  const int nodes_;
  TemporaryFolder folder_;
};

}  // namespace strut::test
