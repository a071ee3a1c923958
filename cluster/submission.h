// What a submission left in the sweep's folder: enough to find its tasks again.
//
//   DIR/jobs/NAME/submission.toml   written before anything is queued
//   DIR/jobs/NAME/ARRAY.sh          what the scheduler got
//   DIR/jobs/NAME/ARRAY.job         the job that the scheduler made of it
//   DIR/jobs/NAME/ARRAY/TASK        the lives of a task (task_record.h)
//   DIR/jobs/NAME/cancelled         a mark
//   DIR/jobs/NAME/over              a mark; what the scheduler remembered of its tasks' ends
//
// The folder may have come from elsewhere: names and numbers read from it are checked, nothing is
// written through a link, and a job is not touched before the dispatcher has proved it ours.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cluster/dispatcher.h"
#include "cluster/packing.h"
#include "io/store/sweep_folder.h"

namespace strut {

/// By array and task, how it ended in the scheduler's own terms, which forgets: "TIMEOUT".
using TaskWords = std::map<std::pair<std::size_t, std::int64_t>, std::string>;

struct Submission {
  std::filesystem::path folder;  // DIR/jobs/NAME
  std::string dispatcher;
  std::string place;       // Dispatcher::find_place() of where it was submitted
  std::string user;        // who submitted it, by number
  std::string job_prefix;  // names of jobs begin so, and nobody else's do
  std::vector<PackedArray> arrays;
  bool retries = false;   // a job behind all arrays tries once more what failed
  bool collects = false;  // a last job, behind all others, merges

  std::string name() const { return folder.filename().string(); }
  std::filesystem::path sweep() const { return folder.parent_path().parent_path(); }
  /// Its folder, for reading and writing. Throws InputError where a link stands in its place.
  Folder open() const;
  /// "array-0", ..., "retry", "collect": its files, and with the prefix its job.
  std::string array_name(std::size_t array) const { return "array-" + std::to_string(array); }
  static constexpr const char* kRetry = "retry";
  static constexpr const char* kCollect = "collect";
  std::string job_name(const std::string& part) const { return job_prefix + "." + part; }
  /// Names of all parts, in the order in which they are queued.
  std::vector<std::string> list_parts() const;

  static std::string script_name(const std::string& part) { return part + ".sh"; }

  /// A part as its scheduler knows it; `job` is "" where it was never queued, or nobody lived to
  /// write it down.
  JobRecord read_job(const std::string& part) const;
  void write_job(const std::string& part, const std::string& job) const;

  bool is_cancelled() const { return open().has("cancelled"); }
  void mark_cancelled() const;
  void take_back_cancelled() const;
  /// Nothing of it is queued any more, and nothing will be.
  bool is_over() const { return open().has("over"); }
  void mark_over(const TaskWords& words) const;
  /// As mark_over() left them.
  TaskWords read_words() const;
};

/// The number of the user whom this process runs for.
std::string find_user();

/// Gives a submission the next folder, its name, a prefix that nobody else's jobs have, and its
/// submission.toml. Throws EnvironmentError.
Submission make_submission(const SweepFolder& folder, Submission submission);

/// One of a sweep, by its name. Throws InputError where there is none, or it is damaged.
Submission find_submission(const SweepFolder& folder, const std::string& name);
/// All of a sweep, the oldest first. Throws InputError where one is damaged; or leaves it out and
/// tells of it in `faults`, where that is given.
std::vector<Submission> list_submissions(const SweepFolder& folder,
                                         std::vector<std::string>* faults = nullptr);

}  // namespace strut
