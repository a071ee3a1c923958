#include "jobs/cancel.h"

#include <iostream>

#include "jobs/command.h"
#include "jobs/dispatch/follow.h"
#include "jobs/open_sweep.h"

namespace strut {
namespace {

/// Its jobs, those included that a killed submit did not live to write down.
std::vector<std::string> list_jobs(const Submission& submission, const Dispatcher& dispatcher) {
  std::vector<std::string> jobs;
  for (const std::string& part : submission.list_parts()) {
    std::string job = submission.read_job(part);
    if (job.empty()) job = dispatcher.find_job(submission.job_name(part));
    if (!job.empty()) jobs.push_back(std::move(job));
  }
  return jobs;
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
    if (submission.is_over()) continue;
    const auto dispatcher = make_dispatcher(submission.dispatcher);
    // Before the tasks stop: they tell by it why they did.
    submission.mark_cancelled();
    const std::vector<std::string> jobs = list_jobs(submission, *dispatcher);
    if (!jobs.empty()) dispatcher->cancel(jobs);
    std::cout << "submission " << submission.name() << ": " << jobs.size() << " jobs cancelled\n";
    ++cancelled;
  }
  if (cancelled == 0) std::cout << "nothing to cancel: no submission waits or runs\n";
  return kExitDone;
}

}  // namespace strut
