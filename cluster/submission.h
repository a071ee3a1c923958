// The record of a submission in the sweep's folder, by which its tasks are found again.
//
//   DIR/jobs/NAME/submission.toml   written before anything is queued
//   DIR/jobs/NAME/ARRAY.sh          the script given to the scheduler
//   DIR/jobs/NAME/ARRAY.job         the job that the scheduler made of it
//   DIR/jobs/NAME/ARRAY/TASK        the attempts of a task (task_record.h)
//   DIR/jobs/NAME/cancelled         a mark
//   DIR/jobs/NAME/over              a mark; final states of its tasks from the scheduler
//
// The folder may have come from elsewhere: names and numbers read from it are checked, nothing is
// written through a link, and a job is not touched before the dispatcher has proved that it is this
// submission's.
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

/// Final states in the scheduler's own terms ("TIMEOUT"), which it forgets, by array and task.
using SchedulerStates = std::map<std::pair<std::size_t, std::int64_t>, std::string>;

struct Submission {
  std::filesystem::path folder;  // DIR/jobs/NAME
  std::string dispatcher;
  std::string cluster_name;  // Dispatcher::find_cluster_name() at submission
  std::string user;          // number of the user who submitted it
  std::string job_prefix;    // prefix of the names of its jobs, unique to it
  std::vector<PackedArray> arrays;
  bool retries = false;   // a job after all arrays retries failed cases
  bool collects = false;  // a last job, after all others, merges

  std::string name() const { return folder.filename().string(); }
  std::filesystem::path sweep() const { return folder.parent_path().parent_path(); }
  /// Opens its folder for reading and writing. Throws InputError if a link stands in its place.
  Folder open() const;
  /// Names of parts: "array-0", ..., "retry", "collect". Files have the same names, and jobs have
  /// them after the prefix.
  std::string array_name(std::size_t array) const { return "array-" + std::to_string(array); }
  static constexpr const char* kCancelled = "cancelled";  // file that marks it so
  static constexpr const char* kOver = "over";            // likewise
  static constexpr const char* kRetry = "retry";
  static constexpr const char* kCollect = "collect";
  std::string job_name(const std::string& part) const { return job_prefix + "." + part; }
  /// Returns the names of all parts in the order in which they are queued.
  std::vector<std::string> list_parts() const;

  static std::string script_name(const std::string& part) { return part + ".sh"; }

  /// Reads the job of a part; `job` is "" if it was never queued, or if the submit was killed
  /// before it was recorded.
  JobRecord read_job(const std::string& part) const;
  void write_job(const std::string& part, const std::string& job) const;

  bool is_cancelled() const { return open().has(kCancelled); }
  void mark_cancelled() const;
  void unmark_cancelled() const;
  /// Returns whether none of its jobs is queued and none will be.
  bool is_finished() const { return open().has(kOver); }
  void mark_finished(const SchedulerStates& states) const;
  /// Reads the states that mark_finished() wrote.
  SchedulerStates read_scheduler_states() const;
};

/// Returns the number of the user of this process.
std::string find_user();

/// Gives a submission the next folder and name, a unique job prefix and its submission.toml. Throws
/// EnvironmentError.
Submission make_submission(const SweepFolder& folder, Submission submission);

/// Reads the submission of that name. Throws InputError if there is none or it is damaged.
Submission find_submission(const SweepFolder& folder, const std::string& name);
/// Reads all submissions of a sweep, the oldest first. If one is damaged, throws InputError or, if
/// `faults` is given, skips it and appends the message there.
std::vector<Submission> list_submissions(const SweepFolder& folder,
                                         std::vector<std::string>* faults = nullptr);

}  // namespace strut
