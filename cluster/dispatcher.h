// Runs the tasks of a sweep. Each scheduler is one class derived from Dispatcher.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error/finding.h"

namespace strut {

/// Resources of one task; empty or 0: the site's default.
struct Resources {
  std::string partition, account, constraint, memory;
  int threads = 1;
  double seconds = 0.0;            // wall clock
  double warning = 0.0;            // s before the time limit at which a task is asked to finish
  std::vector<std::string> extra;  // further options, each one word of the scheduler's command
  bool is_shared = false;          // the user asserts that all machines see the sweep's folder
};

/// Limits of a site.
struct SiteLimits {
  std::int64_t array_tasks = std::numeric_limits<std::int64_t>::max();  // in one array
  std::int64_t tasks = std::numeric_limits<std::int64_t>::max();  // queued at once, all arrays
  double seconds = std::numeric_limits<double>::infinity();       // wall clock of one task
};

/// A program to run for each of `tasks` tasks, and its resources.
struct TaskArray {
  std::string name;
  std::vector<std::string> preparation;  // lines of bash; $task: 0 ... tasks - 1, $threads
  std::string program;                   // the line after them; receives the task's signals
  std::int64_t tasks = 1;
  std::int64_t at_once = 0;  // max. number of tasks that run at once; 0: no limit
  bool is_array = true;      // false: one task without a number
  Resources resources;
  std::filesystem::path folder;  // for the output files, NAME-*.log
  std::string mark;              // make_job_mark()
};

/// Returns the mark of a job that strut started for this very folder, 32 hexadecimal digits:
/// STRUT_JOB in the environment of a process, or the comment of a Slurm job. Copies of the sweep's
/// folder have jobs with the same names but different marks.
std::string make_job_mark(const std::filesystem::path& sweep, const std::string& job_name);

/// A job as recorded in the files of a submission. The files may have come from elsewhere: before
/// it acts, a dispatcher proves that the job is the recorded one.
struct JobRecord {
  std::string part;  // part of the submission
  std::string job;   // as submit() returned it
  std::string name;  // TaskArray::name
  std::string mark;
  std::filesystem::path file;  // the record
};

enum class TaskState { kPending, kRunning, kEnded };

/// A scheduler's report on one task, or on several pending tasks in the same state.
struct QueuedTasks {
  std::string job;        // as submit() returned it
  std::int64_t task = 0;  // number of the first; -1: the job is not an array
  std::int64_t count = 1;
  TaskState state = TaskState::kPending;
  std::string scheduler_state;  // in the scheduler's own terms: "TIMEOUT"
  std::string reason;           // for waiting or ending: "Resources"
};

/// A scheduler's report on jobs, queued and remembered. A job without an entry in `tasks` does not
/// exist, unless the query failed.
struct QueueAnswer {
  std::vector<QueuedTasks> tasks;
  std::string failure;  // why there is no answer: the jobs may or may not run; empty: none
};

/// Instruction sets that this program can use on a node, the widest first.
struct NodeInstructionSets {
  std::string name, sets;
};

/// Returns the QueueAnswer::failure for a job that runs without the mark of this folder.
std::string describe_foreign(const std::string& job, const std::string& name);

class Dispatcher {
 public:
  virtual ~Dispatcher() = default;

  virtual std::string name() const = 0;
  /// Returns the name of the cluster, since clusters do not know each other's jobs. Throws
  /// EnvironmentError if the scheduler does not answer.
  virtual std::string find_cluster_name() const = 0;

  /// Returns the limits of the site. Throws InputError or EnvironmentError for every fault that can
  /// be found before submitting: no scheduler, unknown partition, nodes that cannot see `folder`.
  virtual SiteLimits check(const Resources& resources,
                           const std::filesystem::path& folder) const = 0;

  /// Reports to the user what works on this site, what does not, and its limits.
  virtual Findings examine(const Resources& resources,
                           const std::filesystem::path& folder) const = 0;
  /// Returns the instruction sets of each idle node.
  virtual std::vector<NodeInstructionSets> list_node_instruction_sets(
      const Resources& resources) const = 0;

  /// Returns the script for submit(). Every external text in it is one quoted word of bash.
  virtual std::string make_script(const TaskArray& tasks) const = 0;
  /// Returns the command that submit() runs, for display.
  virtual std::vector<std::string> make_command(const TaskArray& tasks,
                                                const std::filesystem::path& script,
                                                const std::vector<std::string>& after) const = 0;
  /// Returns the scheduler's answer to a submission without queuing anything; "" if it cannot be
  /// asked. Throws EnvironmentError if it would refuse the submission.
  virtual std::string dry_run(const TaskArray& tasks) const = 0;

  /// Queues a script, to start once the jobs `after` have ended, successfully or not. Returns the
  /// job. Throws EnvironmentError.
  virtual std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                             const std::vector<std::string>& after) const = 0;
  /// Finds the job of a record without a number, which a killed submit() may have queued; "" if
  /// there is none. Throws EnvironmentError if that cannot be determined.
  virtual std::string find_job(const JobRecord& record) const = 0;

  /// Reports on jobs. A scheduler that lost its records may have reused a number; if a job with a
  /// record's number and name runs without its mark, the query fails. Throws InputError if a record
  /// cannot be that of a job.
  virtual QueueAnswer query(const std::vector<JobRecord>& jobs) const = 0;

  /// Ends jobs, running or pending, after proving all of them. Throws as query() does, and
  /// EnvironmentError if the query fails.
  virtual void cancel(const std::vector<JobRecord>& jobs) const = 0;

  /// Puts the task of this process back into the queue; false if that is impossible.
  virtual bool requeue_own() const = 0;
  /// Returns the time limit of the task of this process [s since 1970]; 0: unknown.
  virtual std::int64_t find_own_deadline() const = 0;
  /// Returns how often the task of this process was started before.
  virtual int count_own_restarts() const = 0;
};

std::vector<std::string> list_dispatchers();
/// Returns the cluster's dispatcher if there is a cluster, otherwise "local".
std::string find_dispatcher();
/// Makes one of list_dispatchers(). Throws std::out_of_range.
std::unique_ptr<Dispatcher> make_dispatcher(const std::string& name);

}  // namespace strut
