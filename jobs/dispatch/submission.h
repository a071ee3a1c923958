// What a submission left in the sweep's folder: enough to find its tasks again.
//
//   DIR/jobs/NAME/submission.toml   written before anything is queued
//   DIR/jobs/NAME/ARRAY.sh          what the scheduler got
//   DIR/jobs/NAME/ARRAY.job         the job that the scheduler made of it
//   DIR/jobs/NAME/ARRAY/TASK        the lives of a task (task_record.h)
//   DIR/jobs/NAME/cancelled, over   marks
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/sweep_folder.h"
#include "jobs/dispatch/packing.h"

namespace strut {

struct Submission {
  std::filesystem::path folder;  // DIR/jobs/NAME
  std::string dispatcher;
  std::string job_prefix;  // names of jobs begin so, and nobody else's do
  std::vector<PackedArray> arrays;
  bool retries = false;   // a job behind all arrays tries once more what failed
  bool collects = false;  // a last job, behind all others, merges

  std::string name() const { return folder.filename().string(); }
  /// "array-0", ..., "retry", "collect": its files, and with the prefix its job.
  std::string array_name(std::size_t array) const { return "array-" + std::to_string(array); }
  static constexpr const char* kRetry = "retry";
  static constexpr const char* kCollect = "collect";
  std::string job_name(const std::string& part) const { return job_prefix + "." + part; }
  /// Names of all parts, in the order in which they are queued.
  std::vector<std::string> list_parts() const;

  std::filesystem::path script(const std::string& part) const { return folder / (part + ".sh"); }
  std::filesystem::path tasks(std::size_t array) const { return folder / array_name(array); }

  /// The scheduler's name for a part; "" where it was never queued, or nobody lived to write it.
  std::string read_job(const std::string& part) const;
  void write_job(const std::string& part, const std::string& job) const;

  bool is_cancelled() const { return std::filesystem::exists(folder / "cancelled"); }
  void mark_cancelled() const;
  /// Nothing of it is queued any more, and nothing will be.
  bool is_over() const { return std::filesystem::exists(folder / "over"); }
  void mark_over() const;
};

/// Gives a submission the next folder, its name, and its submission.toml. Throws EnvironmentError.
Submission make_submission(const SweepFolder& folder, Submission submission);

/// All of a sweep, the oldest first. Throws InputError where one is damaged.
std::vector<Submission> list_submissions(const SweepFolder& folder);

}  // namespace strut
