#include "jobs/cancel.h"

#include <fmt/format.h>

#include <iostream>
#include <stdexcept>

#include "cluster/follow.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"

namespace strut {
namespace {

/// Cancels the queued jobs of a submission. Throws EnvironmentError if the dispatcher does not
/// answer or refuses, InputError if the files name a job that is not one of the submission.
void cancel(const Submission& submission) {
  const auto dispatcher = make_dispatcher(submission.dispatcher);
  // Set before the tasks stop, since they record it as the cause; it also ends a running submit.
  submission.mark_cancelled();
  try {
    const std::vector<JobRecord> jobs = find_jobs(submission, *dispatcher);
    dispatcher->cancel(jobs);
    std::cout << fmt::format("submission {}: {} {} cancelled\n", submission.name(), jobs.size(),
                             jobs.size() == 1 ? "job" : "jobs");
  } catch (const std::runtime_error&) {
    submission.unmark_cancelled();
    throw;
  }
}

}  // namespace

Arguments describe_cancel() {
  Arguments arguments(
      "strut cancel DIR",
      "Cancels the queued jobs of the sweep in DIR: waiting tasks are dropped, running tasks stop\n"
      "cleanly. Finished shards are kept; `strut submit` or `strut run` continues. Runs that were\n"
      "started by hand are not affected.",
      "  strut cancel cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  return arguments;
}

int run_cancel(const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  const std::string root = sweep.folder.root.string();
  std::string dispatcher;  // dispatcher of the last cancelled submission
  bool is_unknown = false;
  for (const Submission& submission : list_submissions(sweep.folder)) {
    const SubmissionState state = follow(submission);
    if (state.queue == QueueState::kEnded) continue;
    if (state.queue == QueueState::kUnknown) {
      print_error("submission " + submission.name() +
                  ": unknown whether it still runs: " + state.why_unknown +
                  "; it is not cancelled; try again later, or stop its job by hand");
      is_unknown = true;
      continue;
    }
    cancel(submission);
    dispatcher = submission.dispatcher;
  }
  if (is_unknown) return kExitEnvironment;
  if (dispatcher.empty()) {
    std::cout << "nothing to cancel: no submission waits or runs\n";
    suggest_next({"strut", "status", root});
  } else {
    suggest_next({"strut", "submit", root, "--to", dispatcher}, "continues from here");
  }
  return kExitDone;
}

}  // namespace strut
