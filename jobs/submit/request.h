// Options of `strut submit`.
#pragma once

#include <filesystem>

#include "cluster/dispatcher.h"
#include "jobs/cli/arguments.h"

namespace strut {

struct SubmitRequest {
  Resources resources;  // for one task; seconds 0: chosen by plan_tasks()
  std::int64_t max_tasks = 1;
  double task_seconds = 600.0;   // target duration of a task
  std::int64_t at_once = 0;      // tasks of an array that run at once; 0: no limit
  std::string scratch;           // node-local folder; empty: none
  std::string prologue;          // lines of bash before the program
  bool retries = false;          // --retry
  bool merges = false;           // --merge
  bool ignores_unknown = false;  // --again
};

/// --to list: the commands, for any other scheduler.
inline constexpr char kToList[] = "list";
std::vector<std::string> list_targets();

/// The dispatcher of --to; that of this machine for `list`. Throws InputError.
std::unique_ptr<Dispatcher> read_dispatcher(const Arguments& arguments);

/// Reads all other options. Throws InputError.
SubmitRequest read_submit_request(const Arguments& arguments, const Dispatcher& dispatcher);

}  // namespace strut
