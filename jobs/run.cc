#include "jobs/run.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <iostream>
#include <optional>

#include "base/text/build_info.h"
#include "base/text/parse_number.h"
#include "cluster/task_run.h"
#include "io/format/json.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/machine.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "sweep/run.h"
#include "sweep/status.h"

namespace strut {
namespace {

Arguments describe(const std::string& name, bool retries) {
  Arguments arguments(
      "strut " + name + " DIR [OPTIONS]",
      std::string("Simulates every case of the sweep in DIR that is not done yet, and writes whole "
                  "shards to\nDIR/shards. Stop it when you like (Ctrl-C): running it again goes on "
                  "from there, without the\nfew shards that were unfinished. Several may "
                  "run on one folder, also on several hosts.\n") +
          (retries ? "Then tries what failed once more, with a quarter of the step it failed with; "
                     "three resumes may\ndo so one after the other.\n"
                   : "") +
          "Ends with code 1 where cases failed.",
      "  strut plan examples/sweeps/paper.toml -o cars\n  strut " + name +
          " cars --threads 2\n  strut status cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("threads", "N", "worker threads (default: one for each processor)");
  arguments.add_option("shards", "A:B", "only shards A to B - 1 (default: all)");
  arguments.add_option("task", "NAME", "the shards of a task that `strut submit` made");
  arguments.add_option("isa", isa_value(),
                       "instruction set, one that --version lists (default: widest)");
  arguments.add_option("lease", "S",
                       "a runner on another host counts as dead after S seconds without a sign of "
                       "life (default 30)");
  arguments.add_switch("json", "print the summary as JSON");
  return arguments;
}

/// "A:B"; either may be left out.
void read_shards(const Arguments& arguments, const Plan& plan, RunOptions& options) {
  options.end_shard = plan.shard_count();
  if (!arguments.has("shards")) return;
  const std::string text = arguments.text("shards");
  const std::size_t colon = text.find(':');
  const auto parse = [&](const std::string& number, std::int64_t fallback) {
    return number.empty() ? fallback : parse_number<std::int64_t>(number).value_or(-1);
  };
  const std::int64_t first = parse(text.substr(0, colon), 0);
  const std::int64_t end =
      colon == std::string::npos ? -1 : parse(text.substr(colon + 1), plan.shard_count());
  if (first < 0 || end <= first || end > plan.shard_count()) {
    throw InputError("--shards " + text + ": must be A:B with 0 <= A < B <= " +
                     std::to_string(plan.shard_count()) + ", the shards of this sweep");
  }
  options.first_shard = first;
  options.end_shard = end;
}

RunOptions read_options(const Arguments& arguments, const Plan& plan, bool retries) {
  RunOptions options;
  options.kernel = &find_kernel(arguments);
  options.threads = find_threads(arguments);
  options.retry_failed = retries;
  read_shards(arguments, plan, options);
  const double lease = arguments.number_or("lease", 30.0, between(1.0, 86400.0, "s"));
  options.claims.lease = std::chrono::milliseconds(std::llround(1e3 * lease));
  options.provenance = make_run_provenance();
  return options;
}

/// Rate and time to go are of all runners on this folder, as far as this one knows of them.
std::string describe_progress(const RunProgress& progress, double start) {
  const std::int64_t done = progress.elsewhere + progress.simulated;
  const std::int64_t reached = progress.present + done;
  const double rate = static_cast<double>(done) / (now() - start);
  const double left = static_cast<double>(progress.cases - reached) / rate;
  std::string line = format_count(reached) + "/" + format_count(progress.cases) + " cases";
  if (reached < progress.cases) {
    line += ", " + format_count(std::llround(rate)) + "/s, " + format_duration(left) + " to go";
  }
  if (progress.failed > 0) line += ", " + format_count(progress.failed) + " failed";
  if (progress.retried > 0) line += ", " + format_count(progress.retried) + " tried again";
  return line;
}

Json make_json(const RunProgress& progress, const RunSummary& summary, double seconds) {
  Json damaged = Json::array();
  for (const auto& [shard, what] : summary.damaged) damaged.push_back(what);
  Json parts = Json::object();
  parts["prepare"] = summary.simulation.prepare;
  parts["integrate"] = summary.simulation.integrate;
  parts["retry"] = summary.simulation.retry;
  parts["compress"] = summary.compress;
  parts["write"] = summary.write;
  Json json = Json::object();
  json["cases"] = progress.cases.load();
  json["present"] = progress.present.load();
  json["written"] = progress.written.load();
  json["elsewhere"] = progress.elsewhere.load();
  json["failed"] = summary.failed;
  json["mended"] = summary.mended;
  json["still_failing"] = summary.still_failing;
  json["duplicates"] = summary.duplicates;
  json["shards"] = summary.shards_written;
  json["bytes"] = summary.bytes;
  json["seconds"] = seconds;
  json["runs_per_s"] = static_cast<double>(progress.written) / seconds;
  json["thread_seconds"] = parts;
  json["damaged"] = damaged;
  json["interrupted"] = summary.stopped;
  return json;
}

void print_summary(const OpenSweep& sweep, const RunProgress& progress, const RunSummary& summary,
                   double seconds) {
  const std::int64_t present = progress.present + progress.elsewhere;
  std::cout << format_count(progress.written) << " cases simulated in " << format_duration(seconds)
            << " (" << format_count(std::llround(static_cast<double>(progress.written) / seconds))
            << "/s)";
  if (present > 0) std::cout << ", " << format_count(present) << " were there already";
  std::cout << "; " << format_count(summary.failed) << " failed in all\n";
  const std::int64_t dropped = progress.simulated - progress.written;
  if (dropped > 0) {
    std::cout << format_count(dropped) << " cases of unfinished shards are dropped\n";
  }
  if (summary.mended + summary.still_failing > 0) {
    std::cout << "tried again: " << format_count(summary.mended) << " mended, "
              << format_count(summary.still_failing) << " still fail\n";
  }
  if (summary.duplicates > 0) {
    std::cout << summary.duplicates
              << " shards were made twice, by two runners; one copy is kept\n";
  }
  std::cout << "data: " << sweep.folder.shards().string() << " ("
            << format_count(summary.shards_written) << " shards, "
            << format_bytes(static_cast<double>(summary.bytes)) << " new)\n";
}

void tell(const RunSummary& summary) {
  print_notes(summary.notes);
  for (const auto& [shard, what] : summary.damaged) print_error(what);
}

/// The task of --task, whose shards are then those to be done.
std::optional<TaskRun> find_task(const Arguments& arguments, const OpenSweep& sweep,
                                 RunOptions& options) {
  if (!arguments.has("task")) return std::nullopt;
  if (arguments.has("shards")) throw InputError("--task, --shards: must not both be given");
  std::optional<TaskRun> task(std::in_place, sweep.folder, arguments.text("task"),
                              sweep.plan.shard_count());
  options.first_shard = task->shards().first;
  options.end_shard = task->shards().end;
  return task;
}

bool is_complete(const RunProgress& progress) {
  return progress.present + progress.written + progress.elsewhere >= progress.cases;
}

/// The same of the whole sweep, where this run was to do some shards of it.
bool is_complete_sweep(const OpenSweep& sweep, const RunProgress& progress) {
  return progress.cases == sweep.plan.case_count() && is_complete(progress);
}

TaskOutcome judge_end(const RunProgress& progress, const RunSummary& summary) {
  if (summary.stopped) return TaskOutcome::kStopped;
  if (!is_complete(progress)) return TaskOutcome::kDrained;
  return summary.failed > 0 || !summary.damaged.empty() ? TaskOutcome::kFailed : TaskOutcome::kDone;
}

/// run_sweep as a task that tells how it ends.
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
      // As on a full disk; what stopped the run is what is to be told.
    }
    throw;
  }
}

/// What is said, and done, where a scheduler's warning ended the run.
void leave_drained(const OpenSweep& sweep, const std::optional<TaskRun>& task) {
  const std::string root = sweep.folder.root.string();
  print_error("warned of a time limit (SIGUSR1); what is written is whole");
  const std::string why = task ? task->requeue() : "";
  if (task) print_note(why.empty() ? "queued again" : "not queued again: " + why);
  if (task && why.empty()) {
    suggest_next({"strut", "status", root, "--watch"});
  } else {
    suggest_next({"strut", "run", root}, "goes on from here");
  }
}

/// Whether a resume may mend some of what failed.
bool has_untried(const OpenSweep& sweep) {
  return read_status(sweep.folder, sweep.plan).untried > 0;
}

/// What is to be done with the sweep as it is now.
void suggest_next_step(const OpenSweep& sweep, const RunProgress& progress,
                       const RunSummary& summary, bool retries) {
  const std::string root = sweep.folder.root.string();
  if (!summary.damaged.empty()) {
    suggest_next({"strut", "verify", root, "--quarantine"}, "moves damaged files aside, then run");
  } else if (summary.failed > 0 && !retries && has_untried(sweep)) {
    suggest_next({"strut", "resume", root}, "tries what failed again, with shorter steps");
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
  RunOptions options = read_options(arguments, sweep.plan, retries);
  std::optional<TaskRun> task = find_task(arguments, sweep, options);
  if (task && task->is_cancelled()) {
    print_note("its submission is cancelled");
    suggest_next({"strut", "status", sweep.folder.root.string()});
    return kExitDone;
  }
  print_detail(std::to_string(options.threads) + " threads, instruction set " +
               options.kernel->isa + ", shards " + std::to_string(options.first_shard) + " to " +
               std::to_string(options.end_shard - 1));
  prepare_interrupt(arguments, "goes on from here");
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
  tell(summary);
  if (arguments.is_on("json")) {
    std::cout << format_json(make_json(progress, summary, seconds)) << "\n";
  } else {
    print_summary(sweep, progress, summary, seconds);
  }
  if (watcher.signal() != 0) {
    print_error("interrupted; what is written is whole");
    suggest_again(arguments, "goes on from here");
    return 128 + watcher.signal();
  }
  if (watcher.warned() && !is_complete(progress)) {
    leave_drained(sweep, task);
    return 128 + SIGUSR1;
  }
  suggest_next_step(sweep, progress, summary, retries);
  return summary.failed > 0 || !summary.damaged.empty() ? kExitNegative : kExitDone;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> make_run_provenance() {
  const BuildInfo& build = get_build_info();
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return {{"strut_version", build.version},
          {"commit", build.commit},
          {"compiler", build.compiler},
          {"host", host.data()}};
}

Arguments describe_run() { return describe("run", false); }

int run_run(const Arguments& arguments) { return run(false, arguments); }

Arguments describe_resume() { return describe("resume", true); }

int run_resume(const Arguments& arguments) { return run(true, arguments); }

}  // namespace strut
