// Where the tasks of a sweep run. A further scheduler is one more class of this kind, in one file.
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

/// What one task asks of a machine; empty, 0: as the site has it.
struct Resources {
  std::string partition, account, constraint, memory;
  int threads = 1;
  double seconds = 0.0;            // wall clock
  double warning = 0.0;            // s before that a task is told to finish
  std::vector<std::string> extra;  // further options, each one word of the scheduler's command
  bool is_shared =
      false;  // all machines see the sweep's folder, whatever its file system looks like
};

/// What a site allows.
struct SiteLimits {
  std::int64_t array_tasks = std::numeric_limits<std::int64_t>::max();  // in one array
  std::int64_t tasks = std::numeric_limits<std::int64_t>::max();  // queued at once, all arrays
  double seconds = std::numeric_limits<double>::infinity();       // wall clock of one task
};

/// A program to be run for each of `tasks`, and where.
struct TaskArray {
  std::string name;
  std::vector<std::string> preparation;  // lines of bash; $task: 0 ... tasks - 1, $threads
  std::string program;                   // the line after them; it gets the task's signals
  std::int64_t tasks = 1;
  std::int64_t at_once = 0;  // 0: as many as there is room for
  bool is_array = true;      // false: one task that has no number
  Resources resources;
  std::filesystem::path folder;  // of the output files, NAME-*.log
  std::string mark;              // make_job_mark()
};

/// What tells a job that strut itself started for this very folder, 32 hexadecimal digits:
/// STRUT_JOB in the environment of a process, the comment of a Slurm job. Copies of the sweep's
/// folder have jobs of the same names, but not the same marks.
std::string make_job_mark(const std::filesystem::path& sweep, const std::string& job_name);

/// A job as the files of a submission tell of it. They may have come from elsewhere: a dispatcher
/// proves before it acts that the job is what they say.
struct JobRecord {
  std::string part;  // of the submission
  std::string job;   // as submit() returned it
  std::string name;  // TaskArray::name
  std::string mark;
  std::filesystem::path file;  // that says so
};

enum class TaskState { kPending, kRunning, kEnded };

/// What a scheduler says of one task, or of pending ones alike.
struct QueuedTasks {
  std::string job;        // as submit() returned it
  std::int64_t task = 0;  // of the first; -1: the job is no array
  std::int64_t count = 1;
  TaskState state = TaskState::kPending;
  std::string word;    // in the scheduler's own terms: "TIMEOUT"
  std::string reason;  // why it waits or ended: "Resources"
};

/// What a scheduler says of jobs: what is queued, and what it remembers. Of a job that is not among
/// `tasks` it has said that there is none.
struct QueueAnswer {
  std::vector<QueuedTasks> tasks;
  std::string silence;  // why there is no answer, which tells neither that they run nor that not
};

/// What one node said.
struct NodeAnswer {
  std::string name, answer;
};

/// Silence about a job that runs, but without the mark of this folder.
std::string describe_foreign(const std::string& job, const std::string& name);

class Dispatcher {
 public:
  virtual ~Dispatcher() = default;

  virtual std::string name() const = 0;
  /// Which of them this is, where there may be several that do not know each other's jobs. Throws
  /// EnvironmentError where it does not answer.
  virtual std::string find_place() const = 0;

  /// Refuses what can be known before anything is queued: the scheduler is not there, it does not
  /// know the partition, its machines cannot see `folder`. Throws InputError or EnvironmentError.
  virtual SiteLimits check(const Resources& resources,
                           const std::filesystem::path& folder) const = 0;

  /// What a person should know of this place: what works, what does not, its limits.
  virtual Findings examine(const Resources& resources,
                           const std::filesystem::path& folder) const = 0;
  /// The instruction sets that this program can use on each node that is idle, the widest first.
  virtual std::vector<NodeAnswer> ask_nodes(const Resources& resources) const = 0;

  /// The text of the file that submit() takes. Nothing in it comes from outside but as one quoted
  /// word of bash.
  virtual std::string make_script(const TaskArray& tasks) const = 0;
  /// The command that submit() starts, for people.
  virtual std::vector<std::string> make_command(const TaskArray& tasks,
                                                const std::filesystem::path& script,
                                                const std::vector<std::string>& after) const = 0;
  /// What the scheduler says to it, nothing being queued. "": it cannot be asked. Throws
  /// EnvironmentError where it would refuse it.
  virtual std::string try_tasks(const TaskArray& tasks) const = 0;

  /// Queues a script, to begin when the jobs `after` have ended in whatever way. Returns the job.
  /// Throws EnvironmentError.
  virtual std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                             const std::vector<std::string>& after) const = 0;
  /// The job of a record without number, which a submit() queued without living to say so; "":
  /// none. Throws EnvironmentError where that cannot be told.
  virtual std::string find_job(const JobRecord& record) const = 0;

  /// A scheduler that lost its memory may have given a number to another job since. Where a job of
  /// a record's number and name runs that does not bear its mark, the answer is silence. Throws
  /// InputError where a record names what cannot be a job.
  virtual QueueAnswer query(const std::vector<JobRecord>& jobs) const = 0;

  /// Ends jobs, running or not, all of them proved first. Throws as query() does, and
  /// EnvironmentError where query() has no answer.
  virtual void cancel(const std::vector<JobRecord>& jobs) const = 0;

  /// Of the task that this process is: puts it back into the queue. False where it cannot be.
  virtual bool requeue_own() const = 0;
  /// Of the task that this process is: when its time is over [s since 1970]; 0: unknown.
  virtual std::int64_t find_own_end() const = 0;
  /// How often the task that this process is was begun before.
  virtual int count_own_restarts() const = 0;
};

std::vector<std::string> list_dispatchers();
/// The cluster's where one is there, else "local".
std::string find_dispatcher();
/// One of list_dispatchers(). Throws std::out_of_range.
std::unique_ptr<Dispatcher> make_dispatcher(const std::string& name);

}  // namespace strut
