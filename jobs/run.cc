#include "jobs/run.h"

#include <fmt/format.h>

#include <csignal>
#include <iostream>
#include <optional>

#include "jobs/cli/clock.h"
#include "jobs/cli/command.h"
#include "jobs/cli/failures.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/progress.h"
#include "jobs/run/options.h"
#include "jobs/run/print.h"
#include "sweep/status.h"

namespace strut {
namespace {

Arguments describe(const std::string& name, bool retries) {
  Arguments arguments(
      fmt::format("strut {} DIR [OPTIONS]", name),
      fmt::format("Simulates the missing cases of the sweep in DIR and writes whole shards to "
                  "DIR/shards. It\n"
                  "may be stopped at any time (Ctrl-C): run again, it continues, without the few "
                  "shards that\n"
                  "were unfinished. Several runs may work on one folder, also from several hosts.\n"
                  "{}The exit code is 1 if cases failed, unless --allow-failed is given.",
                  retries ? "Then retries failed cases, with a quarter of the step with which they "
                            "failed, up to\n"
                            "three times. Cases that no smaller step can mend are not retried.\n"
                          : ""),
      fmt::format("  strut plan examples/sweeps/paper.toml -o cars\n"
                  "  strut {} cars --threads 2\n"
                  "  strut status cars",
                  name));
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("threads", "N", "worker threads (default: one for each processor)");
  arguments.add_option("shards", "A:B", "only shards A to B - 1 (default: all)");
  arguments.add_option("task", "NAME", "only the shards of a task of `strut submit`");
  arguments.add_option("isa", isa_value(),
                       "instruction set, one that --version lists (default: widest)");
  arguments.add_option("lease", "S",
                       "lease: a runner on another host counts as dead after S seconds without a "
                       "heartbeat (default 30)");
  arguments.add_switch("allow-failed", "exit with 0 although cases failed; damage is still 1");
  arguments.add_switch("json", "print the summary as JSON");
  return arguments;
}

void print_messages(const RunSummary& summary) {
  print_notes(summary.notes);
  for (const auto& [shard, what] : summary.damaged) print_error(what);
}

bool is_complete(const RunProgress& progress) {
  return progress.present + progress.written + progress.elsewhere >= progress.cases;
}

/// Whether the whole sweep is complete, also if this run was limited to some of its shards.
bool is_complete_sweep(const OpenSweep& sweep, const RunProgress& progress) {
  return progress.cases == sweep.plan.case_count() && is_complete(progress);
}

TaskOutcome judge_end(const RunProgress& progress, const RunSummary& summary) {
  if (summary.stopped) return TaskOutcome::kStopped;
  if (!is_complete(progress)) return TaskOutcome::kDrained;
  return summary.failed > 0 || !summary.damaged.empty() ? TaskOutcome::kFailed : TaskOutcome::kDone;
}

/// Calls run_sweep() as a task, whose end is recorded.
RunSummary run_task(TaskRun& task, const OpenSweep& sweep, const RunOptions& options,
                    RunProgress& progress, std::atomic<bool>& halt) {
  task.begin();
  try {
    RunSummary summary = run_sweep(sweep.folder, sweep.plan, options, progress, halt);
    task.end(judge_end(progress, summary), summary.shards_written);
    return summary;
  } catch (...) {
    try {
      task.end(TaskOutcome::kError, 0);
    } catch (const std::runtime_error&) {
      // As on a full disk. The first error is the one to report.
    }
    throw;
  }
}

/// Reports that a scheduler's warning ended the run; a task is queued again.
void end_drained(const OpenSweep& sweep, const std::optional<TaskRun>& task) {
  const std::string root = sweep.folder.root.string();
  print_error("warned of a time limit (SIGUSR1); files written so far are complete");
  const std::string why = task ? task->requeue() : "";
  if (task) print_note(why.empty() ? "queued again" : "not queued again: " + why);
  if (task && why.empty()) {
    suggest_next({"strut", "status", root, "--watch"});
  } else {
    suggest_next({"strut", "run", root}, "continues from here");
  }
}

/// `untried`: failed cases that a resume may mend.
void suggest_next_step(const OpenSweep& sweep, const RunProgress& progress,
                       const RunSummary& summary, std::int64_t untried, bool retries) {
  const std::string root = sweep.folder.root.string();
  if (!summary.damaged.empty()) {
    suggest_next({"strut", "verify", root, "--quarantine"}, "moves damaged files aside; then run");
  } else if (summary.failed > 0 && !retries && untried > 0) {
    suggest_next({"strut", "resume", root}, "retries failed cases with smaller steps");
  } else if (!is_complete_sweep(sweep, progress)) {
    suggest_next({"strut", "status", root});
  } else if (summary.failed > 0) {
    suggest_next_after_failures(root, summary.failed);
  } else {
    suggest_next({"strut", "verify", root});
  }
}

int run(bool retries, const Arguments& arguments) {
  const OpenSweep sweep = open_sweep(arguments);
  RunOptions options = read_run_options(arguments, sweep.plan, retries);
  std::optional<TaskRun> task = find_task(arguments, sweep, options);
  if (task && task->is_cancelled()) {
    print_note("the submission of this task is cancelled");
    suggest_next({"strut", "status", sweep.folder.root.string()});
    return kExitDone;
  }
  print_detail(fmt::format("{} threads, instruction set {}, shards {} to {}", options.threads,
                           options.kernel->isa, options.first_shard, options.end_shard - 1));
  prepare_interrupt(arguments, "continues from here");
  InterruptWatcher watcher;
  options.drain = &watcher.warned();
  RunProgress progress;
  const double start = now();
  RunSummary summary;
  {
    const ProgressLine line([&] { return describe_progress(progress, start); });
    summary = task ? run_task(*task, sweep, options, progress, watcher.halt())
                   : run_sweep(sweep.folder, sweep.plan, options, progress, watcher.halt());
  }
  const double seconds = now() - start;
  print_messages(summary);
  if (arguments.is_on("json")) {
    std::cout << format_json(make_json(progress, summary, seconds)) << "\n";
  } else {
    print_summary(sweep, progress, summary, seconds);
  }
  if (watcher.signal() != 0) {
    print_error("interrupted; files written so far are complete");
    suggest_again(arguments, "continues from here");
    return 128 + watcher.signal();
  }
  if (watcher.warned() && !is_complete(progress)) {
    end_drained(sweep, task);
    return 128 + SIGUSR1;
  }
  // A run of some shards, as each task of a cluster is, does not read all others for it.
  SweepStatus status;
  if (summary.failed > 0 && is_complete_sweep(sweep, progress)) {
    status = read_status(sweep.folder, sweep.plan);
  }
  if (!arguments.is_on("json")) {
    for (const auto& [reason, count] : status.failures) {
      std::cout << describe_failures(sweep.plan, reason, count) << "\n";
    }
  }
  suggest_next_step(sweep, progress, summary, status.untried, retries);
  const bool has_failed = summary.failed > 0 && !arguments.is_on("allow-failed");
  return has_failed || !summary.damaged.empty() ? kExitNegative : kExitDone;
}

}  // namespace

Arguments describe_run() { return describe("run", false); }

int run_run(const Arguments& arguments) { return run(false, arguments); }

Arguments describe_resume() { return describe("resume", true); }

int run_resume(const Arguments& arguments) { return run(true, arguments); }

}  // namespace strut
