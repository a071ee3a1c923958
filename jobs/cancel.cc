#include "jobs/cancel.h"

#include <iostream>
#include <map>

#include "jobs/command.h"
#include "jobs/dispatch/follow.h"
#include "jobs/open_sweep.h"

namespace strut {
namespace {

/// Takes back what of it is queued. Throws EnvironmentError where that cannot be told or done.
void cancel(const Submission& submission) {
  const auto dispatcher = make_dispatcher(submission.dispatcher);
  // Before the tasks stop: they tell by it why they did. A submit that is under way stops by it.
  submission.mark_cancelled();
  try {
    std::map<std::string, std::string> names;
    for (const auto& [job, part] : find_jobs(submission, *dispatcher)) {
      names[job] = submission.job_name(part);
    }
    dispatcher->cancel(names);
    std::cout << "submission " << submission.name() << ": " << names.size() << " jobs cancelled\n";
  } catch (const EnvironmentError&) {
    submission.take_back_cancelled();
    throw;
  }
}

}  // namespace

int run_cancel(const std::vector<std::string>& words) {
  Arguments arguments("strut cancel DIR",
                      "Takes back what `strut submit` queued for the sweep in DIR: tasks that wait "
                      "are dropped, tasks\n"
                      "that run stop cleanly. What is written stays; `strut submit` or `strut run` "
                      "goes on from there.\n"
                      "Runners that somebody started by hand are left alone.",
                      "  strut cancel sweep");
  if (!arguments.parse(words)) return kExitDone;
  const OpenSweep sweep = open_sweep(arguments);
  int cancelled = 0;
  for (const Submission& submission : list_submissions(sweep.folder)) {
    const SubmissionState state = follow(submission);
    if (state.queue == QueueState::kEnded) continue;
    if (state.queue == QueueState::kUnknown) {
      throw EnvironmentError("submission " + submission.name() +
                             ": whether it still runs is unknown: " + state.why +
                             "; nothing of it is cancelled");
    }
    cancel(submission);
    ++cancelled;
  }
  if (cancelled == 0) std::cout << "nothing to cancel: no submission waits or runs\n";
  return kExitDone;
}

}  // namespace strut
