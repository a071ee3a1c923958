#include "jobs/submit.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <optional>

#include "base/text/quote_word.h"
#include "cluster/slurm.h"
#include "io/format/json.h"
#include "io/store/claims.h"
#include "jobs/cli/command.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/progress.h"
#include "jobs/submit/queue_tasks.h"
#include "jobs/submit/request.h"
#include "jobs/submit/task_plan.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// The sweep by its canonical path, which is written into scripts.
OpenSweep open_canonical_sweep(const Arguments& arguments) {
  OpenSweep sweep = open_sweep(arguments);
  sweep.folder.root = fs::canonical(sweep.folder.root);
  const std::string root = sweep.folder.root.string();
  if (has_control_character(root)) {
    throw InputError(quote_if_needed(root) +
                     ": the path is written into scripts and must not contain control characters, "
                     "such as line breaks; rename the folder");
  }
  return sweep;
}

/// Claims the right to submit: two submits at once would each queue the same missing shards.
void claim_submit(const SweepFolder& folder, std::optional<Claims>& claims) {
  claims.emplace(Folder(folder.root).make_folder(folder.claims().filename()), ClaimOptions());
  if (claims->claim("submit") != Claims::Answer::kMine) {
    throw EnvironmentError(
        folder.root.string() +
        ": another `strut submit` is working on it; try again when it has ended");
  }
}

void report_nothing_to_do(const Arguments& arguments, const OpenSweep& sweep,
                          const MissingWork& work) {
  const std::int64_t shards = sweep.plan.shard_count();
  if (work.present == shards) {
    std::cout << fmt::format("nothing to submit: the sweep's {} there\n",
                             shards == 1 ? "shard is" : format_count(shards, "shard") + " are");
  } else {
    std::cout << fmt::format(
        "nothing to submit: of {}, {} exist; the others belong to tasks that wait or run\n",
        format_count(shards, "shard"), format_count(work.present));
  }
  const std::string root = sweep.folder.root.string();
  if (work.status.failed > 0) {
    std::cout << fmt::format("{} failed\n", format_count(work.status.failed, "case"));
  }
  if (work.status.untried > 0) {
    suggest_again(arguments, "retries failed cases with smaller steps", {"--retry"});
  } else if (work.status.complete()) {
    suggest_next({"strut", "verify", root});
  } else {
    suggest_next({"strut", "status", root, "--watch"});
  }
}

void print_queued(const QueuedSubmission& queued, const TaskPlan& plan, const MissingWork& work,
                  bool as_json) {
  const Submission& s = queued.submission;
  const std::vector<std::string> parts = s.list_parts();
  if (as_json) {
    Json jobs = Json::object();
    for (std::size_t i = 0; i < parts.size(); ++i) jobs[parts[i]] = queued.jobs[i];
    std::cout << format_json(Json{{"submission", s.name()},
                                  {"to", s.dispatcher},
                                  {"tasks", plan.count_tasks()},
                                  {"jobs", jobs}})
              << "\n";
    return;
  }
  std::cout << fmt::format("submission {}: {}\n", s.name(), describe_tasks(plan, work));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::cout << fmt::format("  {}: {} {}\n", parts[i], s.dispatcher, queued.jobs[i]);
  }
}

/// Whether the scheduler is there; notes it if not.
bool can_ask(const Dispatcher& dispatcher) {
  if (dispatcher.name() != SlurmDispatcher::kName) return true;
  const std::string fault = SlurmDispatcher::find_fault();
  if (fault.empty()) return true;
  print_note(fmt::format(
      "no Slurm answers here ({}): limits and partitions of the site are not checked", fault));
  return false;
}

/// The command line of a dry run without --dry-run.
std::vector<std::string> make_real_command(const Arguments& arguments) {
  std::vector<std::string> words = {"strut", "submit"};
  std::copy_if(arguments.words().begin(), arguments.words().end(), std::back_inserter(words),
               [](const std::string& word) { return word != "--dry-run"; });
  return words;
}

}  // namespace

Arguments describe_submit() {
  Arguments arguments(
      "strut submit DIR --to slurm|local|list [OPTIONS]",
      "Queues the missing shards of the sweep in DIR as arrays of tasks of a few minutes each.\n"
      "Submitting again queues only shards that neither exist nor are queued. Tasks near their "
      "time\n"
      "limit finish the current shard and queue themselves again. `--to local` runs the tasks on "
      "this\n"
      "machine, in the background.",
      "  strut submit cars --to slurm --dry-run\n"
      "  strut submit cars --to slurm --partition short --time 30 --threads 8 --at-once 50\n"
      "  strut status cars\n  strut cancel cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("to", ArgumentValue::one_of(list_targets()),
                       "dispatcher that runs the tasks; list prints a command for each, for any "
                       "other scheduler");
  arguments.add_option("partition", "P", "partition of the cluster (default: the site's)");
  arguments.add_option("account", "A", "account to be charged");
  arguments.add_option("constraint", "C", "constraint on nodes");
  arguments.add_option("memory", "M", "memory of a task, in the site's notation: 4G");
  arguments.add_option("time", "T",
                       "walltime of a task: minutes, HH:MM:SS or D-HH:MM:SS (default: twice the "
                       "expected duration)");
  arguments.add_option("threads", "N", "processors of a task (default 1; local: all)");
  arguments.add_option("minutes", "M", "target duration of a task (default 10)");
  arguments.add_option("tasks", "N", "maximum number of tasks");
  arguments.add_option("at-once", "N", "maximum number of an array's tasks that run at once");
  arguments.add_list("option", "OPTION",
                     "additional option for the scheduler, one word: --qos=low");
  arguments.add_option("scratch", ArgumentValue::folder("PATH"),
                       "node-local folder where each node keeps a copy of the program; $NAME and "
                       "${NAME} are expanded on the node");
  arguments.add_option(
      "prologue", ArgumentValue::file("FILE", {}),
      "lines of bash before the program, as `module load gcc`; an array `launcher` "
      "in it is put before the program, as (apptainer exec strut.sif)");
  arguments.add_switch("shared",
                       "all nodes can access DIR, although it is on a disk of this machine (which "
                       "exports it)");
  arguments.add_switch(
      "retry", "add a task, after the arrays, that retries failed cases like `strut resume`");
  arguments.add_removed("no-merge", "nothing is merged without --merge");
  arguments.add_switch("merge", "add a last task that writes DIR/merged.h5");
  arguments.add_switch("again",
                       "submit although it is unknown whether an earlier submission still runs");
  arguments.add_switch("dry-run", "print the scripts and their dependencies; queue nothing");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_submit(const Arguments& arguments) {
  const OpenSweep sweep = open_canonical_sweep(arguments);
  const std::unique_ptr<Dispatcher> dispatcher = read_dispatcher(arguments);
  const SubmitRequest request = read_submit_request(arguments, *dispatcher);
  const bool is_list = arguments.text("to") == kToList;
  const bool is_dry = arguments.is_on("dry-run") || is_list;
  if (is_list && arguments.is_on("json")) {
    throw InputError("--json: not with --to list, whose output is commands");
  }
  std::optional<Claims> claims;
  if (!is_dry) claim_submit(sweep.folder, claims);
  const MissingWork work = find_missing_work(sweep, request, is_dry);
  if (work.is_empty() && is_dry && arguments.is_on("json")) {
    std::cout << format_json(Json{{"to", dispatcher->name()}, {"parts", Json::array()}}) << "\n";
    return kExitDone;
  }
  if (work.is_empty()) {
    report_nothing_to_do(arguments, sweep, work);
    return kExitDone;
  }
  const bool asks_scheduler = !is_dry || can_ask(*dispatcher);
  SiteLimits limits;
  if (asks_scheduler) limits = dispatcher->check(request.resources, sweep.folder.root);
  limits.tasks = std::min(request.max_tasks, limits.tasks);
  const int threads = request.resources.threads;
  const WorkEstimate estimate = estimate_work(sweep, work);
  const double shard_seconds =
      estimate.case_seconds * static_cast<double>(sweep.plan.shard_size(0)) / threads;
  const TaskPlan plan = plan_tasks(work, shard_seconds, request, limits, *dispatcher);
  print_detail(
      fmt::format("a shard takes about {} on {} threads", format_duration(shard_seconds), threads));

  if (is_list) {
    print_commands(sweep, plan, work, request);
    print_note(describe_tasks(plan, work) + "; " + describe_work(estimate));
    suggest_next({"strut", "status", sweep.folder.root.string(), "--watch"},
                 "once a scheduler of your own runs these lines, in any order, the last ones last");
    return kExitDone;
  }
  Submission submission =
      make_submission_request(sweep, plan, work, request, *dispatcher,
                              asks_scheduler ? dispatcher->find_cluster_name() : "");
  const ScriptOptions options{plan.resources, request.at_once, request.scratch, request.prologue};
  if (is_dry && arguments.is_on("json")) {
    Json json = make_tasks_json(sweep, submission, options, *dispatcher, asks_scheduler);
    json["core_seconds"] = estimate.core_seconds;
    json["bytes"] = estimate.bytes;
    json["task_seconds"] = plan.task_seconds;
    json["walltime_seconds"] = plan.resources.seconds;
    std::cout << format_json(json) << "\n";
    return kExitDone;
  }
  if (is_dry) {
    std::cout << describe_tasks(plan, work) << "\n" << describe_work(estimate) << "\n";
    print_tasks(sweep, submission, options, *dispatcher, asks_scheduler);
    suggest_next(make_real_command(arguments));
    return kExitDone;
  }
  const QueuedSubmission queued = queue_tasks(sweep, std::move(submission), options, *dispatcher);
  print_queued(queued, plan, work, arguments.is_on("json"));
  const std::string root = sweep.folder.root.string();
  print_note(fmt::format("`strut cancel {}` cancels it", quote_if_needed(root)));
  suggest_next({"strut", "status", root, "--watch"});
  return kExitDone;
}

}  // namespace strut
