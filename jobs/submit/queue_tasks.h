// Queues the tasks of a submission, or prints what would be queued.
#pragma once

#include <string>
#include <vector>

#include "cluster/scripts.h"
#include "io/format/json.h"
#include "jobs/submit/task_plan.h"

namespace strut {

/// The submission of `plan` to a cluster of that name; it has no folder yet.
Submission make_submission_request(const OpenSweep& sweep, const TaskPlan& plan,
                                   const MissingWork& work, const SubmitRequest& request,
                                   const Dispatcher& dispatcher, const std::string& cluster);

/// A submission whose parts are queued; `jobs`: one for each of submission.list_parts().
struct QueuedSubmission {
  Submission submission;
  std::vector<std::string> jobs;
};

/// Gives the submission its folder and queues all parts. Throws InputError if links stand in place
/// of files that the tasks will write, EnvironmentError if the dispatcher refuses a part or the
/// submission is cancelled meanwhile.
QueuedSubmission queue_tasks(const OpenSweep& sweep, Submission submission,
                             const ScriptOptions& options, const Dispatcher& dispatcher);

/// Prints scripts, commands and dependencies of the parts, and, if it is asked, what the scheduler
/// says of them.
void print_tasks(const OpenSweep& sweep, const Submission& submission, const ScriptOptions& options,
                 const Dispatcher& dispatcher, bool asks_scheduler);

/// The same as JSON: for each part its command, script and the parts that it waits for.
Json make_tasks_json(const OpenSweep& sweep, const Submission& submission,
                     const ScriptOptions& options, const Dispatcher& dispatcher,
                     bool asks_scheduler);

/// Prints a command for each task, and those of the retry and the merge behind them.
void print_commands(const OpenSweep& sweep, const TaskPlan& plan, const MissingWork& work,
                    const SubmitRequest& request);

}  // namespace strut
