#include "jobs/cancel.h"

#include <iostream>
#include <stdexcept>

#include "cluster/follow.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"

namespace strut {
namespace {

/// Takes back what of it is queued. Throws EnvironmentError where that cannot be told or done,
/// InputError where its files name what is none of its jobs.
void cancel(const Submission& submission) {
  const auto dispatcher = make_dispatcher(submission.dispatcher);
  // Before the tasks stop: they tell by it why they did. A submit that is under way stops by it.
  submission.mark_cancelled();
  try {
    const std::vector<JobRecord> jobs = find_jobs(submission, *dispatcher);
    dispatcher->cancel(jobs);
    std::cout << "submission " << submission.name() << ": " << jobs.size()
              << (jobs.size() == 1 ? " job cancelled\n" : " jobs cancelled\n");
  } catch (const std::runtime_error&) {
    submission.unmark_cancelled();
    throw;
  }
}

}  // namespace

Arguments describe_cancel() {
  Arguments arguments(
      "strut cancel DIR",
      "Takes back what `strut submit` queued for the sweep in DIR: tasks that wait are dropped, "
      "tasks\n"
      "that run stop cleanly. What is written stays; `strut submit` or `strut run` goes on from\n"
      "there. Runners that somebody started by hand are left alone.",
      "  strut cancel cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  return arguments;
}

int run_cancel(const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  const std::string root = sweep.folder.root.string();
  std::string dispatcher;  // of the last that was cancelled
  bool is_unknown = false;
  for (const Submission& submission : list_submissions(sweep.folder)) {
    const SubmissionState state = follow(submission);
    if (state.queue == QueueState::kEnded) continue;
    if (state.queue == QueueState::kUnknown) {
      print_error("submission " + submission.name() +
                  ": whether it still runs is unknown: " + state.why_unknown +
                  "; nothing of it is cancelled; try again later, or stop its job by hand");
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
    suggest_next({"strut", "submit", root, "--to", dispatcher}, "goes on from here");
  }
  return kExitDone;
}

}  // namespace strut
