#include "jobs/submit.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <optional>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "base/text/quote_word.h"
#include "base/text/range.h"
#include "cluster/follow.h"
#include "cluster/scripts.h"
#include "cluster/slurm.h"
#include "io/file/atomic_file.h"
#include "io/format/json.h"
#include "io/store/claims.h"
#include "jobs/case/plan_estimate.h"
#include "jobs/cli/command.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/messages.h"
#include "jobs/cli/open_sweep.h"
#include "jobs/cli/output_file.h"
#include "jobs/cli/progress.h"
#include "sweep/status.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr double kTaskMinutes = 10.0;
/// A task's walltime over what its shards are expected to take: other processors are slower, and
/// the measurement was short.
constexpr double kReserve = 2.0;
/// Least time that a task is warned before its walltime ends [s]: schedulers look once a minute.
constexpr double kLeastWarning = 60.0;

/// One submission in the making.
class Submitter {
 public:
  explicit Submitter(const Arguments& arguments)
      : arguments_(arguments), sweep_(open_sweep(arguments)) {
    sweep_.folder.root = fs::canonical(sweep_.folder.root);
    if (has_control_character(sweep_.folder.root.string())) {
      throw InputError(quote_if_needed(sweep_.folder.root.string()) +
                       ": must not have control characters, such as a line's end, in its name, "
                       "which goes into scripts; rename the folder");
    }
    if (!arguments.has("to")) {
      throw InputError("--to: missing; must be one of " + join_names(list_dispatchers()));
    }
    const std::vector<std::string> names = list_dispatchers();
    const auto which = static_cast<std::size_t>(arguments.choice_or("to", 0));
    dispatcher_ = make_dispatcher(names[which]);
    read_resources();
    if (arguments.has("scratch")) check_scratch(arguments.text("scratch"));
    limits_ = dispatcher_->check(resources_, sweep_.folder.root);
    limits_.tasks = std::min(arguments.integer_or("tasks", kMaxTasks, 1, kMaxTasks), limits_.tasks);
  }

  int run() {
    // Two who submit at once would each queue what is missing.
    std::optional<Claims> claims;
    if (!arguments_.is_on("dry-run")) {
      claims.emplace(Folder(sweep_.folder.root).make_folder(sweep_.folder.claims().filename()),
                     ClaimOptions());
      if (claims->claim("submit") != Claims::Answer::kMine) {
        throw EnvironmentError(sweep_.folder.root.string() +
                               ": another `strut submit` works on it right now");
      }
    }
    const std::vector<ShardRange> missing = find_missing();
    status_ = read_status(sweep_.folder, sweep_.plan);
    if (missing.empty() && !(retries() && status_.failed > 0)) {
      say_nothing_to_do();
      return kExitDone;
    }
    measure_cost();
    pack(missing);
    print_detail("a shard takes some " + format_duration(shard_seconds_) + " on " +
                 std::to_string(resources_.threads) + " threads");
    if (arguments_.is_on("dry-run")) {
      show();
      std::vector<std::string> words = {"strut", "submit"};
      std::copy_if(arguments_.words().begin(), arguments_.words().end(), std::back_inserter(words),
                   [](const std::string& word) { return word != "--dry-run"; });
      suggest_next(words);
    } else {
      submit();
      const std::string root = sweep_.folder.root.string();
      print_note("`strut cancel " + quote_if_needed(root) + "` stops it");
      suggest_next({"strut", "status", root, "--watch"});
    }
    return kExitDone;
  }

 private:
  void read_resources() {
    const auto text = [&](const char* name) {
      return arguments_.has(name) ? arguments_.text(name) : std::string();
    };
    resources_.partition = text("partition");
    resources_.account = text("account");
    resources_.constraint = text("constraint");
    resources_.memory = text("memory");
    resources_.extra = arguments_.list("option");
    resources_.is_shared = arguments_.is_on("shared");
    const bool here = dispatcher_->name() == "local";
    resources_.threads = here || arguments_.has("threads") ? find_threads(arguments_) : 1;
    if (!arguments_.has("time")) return;
    const auto seconds = parse_slurm_time(arguments_.text("time"));
    if (!seconds || *seconds <= 0.0 || !std::isfinite(*seconds)) {
      throw InputError("--time " + arguments_.text("time") +
                       ": must be minutes, HH:MM:SS or D-HH:MM:SS");
    }
    resources_.seconds = *seconds;
  }

  /// Shards that are neither there nor in a living task's hands.
  std::vector<ShardRange> find_missing() {
    std::vector<ShardRange> live;
    for (const Submission& s : list_submissions(sweep_.folder)) {
      if (s.is_finished()) continue;
      const SubmissionState state = follow(s);
      if (state.queue == QueueState::kUnknown && !arguments_.is_on("again")) {
        throw EnvironmentError("submission " + s.name() +
                               ": whether it still runs is unknown: " + state.why_unknown +
                               "; nothing is submitted; try again later, or with --again");
      }
      // Nobody else is submitting: what a killed submit left unfinished will not be finished.
      if (state.queue == QueueState::kEnded && !arguments_.is_on("dry-run")) {
        s.mark_finished(state.scheduler_states);
      }
      retry_is_queued_ = retry_is_queued_ || state.retries;
      live.insert(live.end(), state.queued_shards.begin(), state.queued_shards.end());
    }
    present_ = list_shards(sweep_.folder);
    return list_missing(sweep_.plan.shard_count(), present_, std::move(live));
  }

  void say_nothing_to_do() const {
    std::cout << "nothing to submit: of " << format_count(sweep_.plan.shard_count()) << " shards "
              << format_count(static_cast<std::int64_t>(present_.size()))
              << " are there, the others in the hands of tasks that wait or run\n";
    const std::string root = sweep_.folder.root.string();
    if (status_.failed > 0) {
      std::cout << format_count(status_.failed) << " cases failed; --retry tries them once more\n";
      suggest_again(arguments_, "tries what failed once more", {"--retry"});
    } else if (status_.complete()) {
      suggest_next({"strut", "verify", root});
    } else {
      suggest_next({"strut", "status", root, "--watch"});
    }
  }

  /// As the shards that are there tell, or, without any, a few cases right now.
  void measure_cost() {
    double thread_seconds = 0.0;  // of a case
    const std::int64_t simulated = status_.done + status_.failed;
    if (simulated > 0) {
      thread_seconds = status_.simulation_seconds / static_cast<double>(simulated);
    } else {
      const ProgressLine line("simulating a few cases for an estimate");
      const SweepEstimate estimate = estimate_sweep(sweep_.plan, find_kernel_or_widest());
      thread_seconds =
          estimate.seconds * estimate.cores / static_cast<double>(sweep_.plan.case_count());
    }
    shard_seconds_ =
        thread_seconds * static_cast<double>(sweep_.plan.shard_size(0)) / resources_.threads;
  }

  static const Kernel& find_kernel_or_widest() { return list_kernels().front(); }

  /// Task sizes, walltime and warning. Throws InputError where one shard does not fit.
  void pack(const std::vector<ShardRange>& missing) {
    PackingRequest request;
    request.limits = limits_;
    request.shard_seconds = shard_seconds_;
    request.task_seconds = 60.0 * arguments_.number_or("minutes", kTaskMinutes, above(0.0, "min"));
    if (dispatcher_->name() == "slurm") {
      resources_.warning = std::ceil(std::max(kLeastWarning, kReserve * shard_seconds_));
      const double most = resources_.seconds > 0.0 ? resources_.seconds : limits_.seconds;
      const double least = 2.0 * resources_.warning;
      if (most < least) {
        throw InputError("--time " + format_slurm_time(most) + ": must be at least " +
                         format_slurm_time(least) + ": one shard takes some " +
                         format_duration(shard_seconds_) + " on " +
                         std::to_string(resources_.threads) +
                         " threads, and tasks are warned in time to finish it; more --threads, or "
                         "a sweep with smaller shards");
      }
      request.task_seconds = std::min(request.task_seconds, (most - resources_.warning) / kReserve);
    }
    arrays_ = pack_shards(missing, request);
    std::int64_t largest = 1;
    for (const PackedArray& array : arrays_) {
      largest = std::max(largest, array.get_task(0).count());
    }
    task_seconds_ = shard_seconds_ * static_cast<double>(largest);
    if (dispatcher_->name() == "slurm" && resources_.seconds == 0.0) {
      resources_.seconds =
          std::min(limits_.seconds, kReserve * task_seconds_ + 2.0 * resources_.warning);
    }
  }

  ScriptOptions make_script_options() const {
    ScriptOptions options;
    options.resources = resources_;
    options.at_once = arguments_.integer_or("at-once", 0, 1, SiteLimits().tasks);
    options.scratch = arguments_.text_or("scratch", "");
    return options;
  }

  std::vector<TaskArray> list_tasks(const Submission& s) const {
    return list_task_arrays(sweep_.folder, s, make_script_options());
  }

  /// Not where an earlier one still waits or runs.
  bool retries() const { return arguments_.is_on("retry") && !retry_is_queued_; }

  /// What is to be queued; it has no folder yet.
  Submission make_request() const {
    Submission s;
    s.dispatcher = dispatcher_->name();
    s.cluster_name = dispatcher_->find_cluster_name();
    s.job_prefix = "strut-" + sweep_.plan.hash().substr(0, 8);
    s.arrays = arrays_;
    s.retries = retries();
    s.collects = arguments_.is_on("merge");
    return s;
  }

  std::int64_t count_tasks() const {
    std::int64_t tasks = 0;
    for (const PackedArray& array : arrays_) tasks += array.tasks();
    return tasks;
  }

  std::string describe() const {
    if (arrays_.empty()) {
      return "one task for " + format_count(status_.failed) + " cases that failed";
    }
    const std::int64_t tasks = count_tasks();
    std::string text =
        format_count(tasks) + (tasks == 1 ? " task" : " tasks") + " in " +
        std::to_string(arrays_.size()) + (arrays_.size() == 1 ? " array" : " arrays") + ", each " +
        format_count(arrays_.front().shards_per_task) + " shards, some " +
        format_duration(task_seconds_) + " on " + std::to_string(resources_.threads) + " threads";
    if (resources_.seconds > 0.0) text += ", walltime " + format_slurm_time(resources_.seconds);
    return text;
  }

  void show() const {
    Submission s = make_request();
    s.folder = sweep_.folder.root / "jobs" / "NEXT";
    s.job_prefix += "-NEXT";
    const std::vector<TaskArray> tasks = list_tasks(s);
    const std::vector<std::string> parts = s.list_parts();
    std::cout << describe() << "\n";
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool waits = i >= s.arrays.size();
      const std::vector<std::string> after(
          parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(waits ? i : 0));
      std::cout << "\n--- " << s.job_name(parts[i]) << "\n$";
      for (const std::string& word : dispatcher_->make_command(
               tasks[i], s.folder / Submission::script_name(parts[i]), after)) {
        std::cout << " " << quote_if_needed(word);
      }
      std::cout << "\n" << dispatcher_->make_script(tasks[i]);
      const std::string said = i == 0 ? dispatcher_->dry_run(tasks[i]) : "";
      if (!said.empty()) std::cout << "(" << dispatcher_->name() << " says: " << said << ")\n";
    }
    std::cout << "\n";
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      std::cout << parts[i] << ": shards " << arrays_[i].shards.first << " to "
                << arrays_[i].shards.end - 1 << ", " << format_count(arrays_[i].tasks())
                << " tasks\n";
    }
    if (s.retries) std::cout << "retry: after all arrays, however they end (afterany)\n";
    if (s.collects) std::cout << "collect: after all others, however they end (afterany)\n";
    std::cout << "nothing is queued\n";
  }

  /// Refuses links in place of what the tasks will write: a scheduler and bash follow them.
  void prepare_folder() const {
    const Folder root(sweep_.folder.root);
    root.make_folder(sweep_.folder.logs().filename().string());
    if (arguments_.is_on("merge")) {
      check_regular(root.descriptor(), kMerged, root.path_of(kMerged));
    }
  }

  void submit() {
    const InterruptGuard guard;  // a job that is queued is also written down
    Submission s = make_request();
    prepare_folder();
    dispatcher_->dry_run(list_tasks(s).front());
    s = make_submission(sweep_.folder, std::move(s));
    const std::vector<TaskArray> tasks = list_tasks(s);
    const std::vector<std::string> parts = s.list_parts();
    std::vector<std::string> jobs;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string script = Submission::script_name(parts[i]);
      write_text_file(s.open(), script, dispatcher_->make_script(tasks[i]));
      const bool waits = i >= s.arrays.size();
      try {
        jobs.push_back(dispatcher_->submit(tasks[i], s.folder / script,
                                           waits ? jobs : std::vector<std::string>()));
      } catch (const EnvironmentError& e) {
        // It may be queued all the same: its name finds it, so nothing is removed here.
        throw EnvironmentError(std::string(e.what()) + "; " + std::to_string(jobs.size()) + " of " +
                               std::to_string(parts.size()) +
                               " jobs are known to be queued, submit again for the rest");
      }
      s.write_job(parts[i], jobs.back());
      if (!s.is_cancelled()) continue;
      dispatcher_->cancel(find_jobs(s, *dispatcher_));
      throw EnvironmentError("submission " + s.name() + ": cancelled meanwhile");
    }
    report(s, parts, jobs);
  }

  void report(const Submission& s, const std::vector<std::string>& parts,
              const std::vector<std::string>& jobs) const {
    if (arguments_.is_on("json")) {
      Json queued = Json::object();
      for (std::size_t i = 0; i < parts.size(); ++i) queued[parts[i]] = jobs[i];
      std::cout << format_json(Json{{"submission", s.name()},
                                    {"to", s.dispatcher},
                                    {"tasks", count_tasks()},
                                    {"jobs", queued}})
                << "\n";
      return;
    }
    std::cout << "submission " << s.name() << ": " << describe() << "\n";
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::cout << "  " << parts[i] << ": " << s.dispatcher << " " << jobs[i] << "\n";
    }
  }

  const Arguments& arguments_;
  OpenSweep sweep_;
  std::unique_ptr<Dispatcher> dispatcher_;
  Resources resources_;
  SiteLimits limits_;
  std::vector<std::int64_t> present_;
  SweepStatus status_;
  bool retry_is_queued_ = false;
  double shard_seconds_ = 0.0, task_seconds_ = 0.0;
  std::vector<PackedArray> arrays_;
};

}  // namespace

Arguments describe_submit() {
  Arguments arguments(
      "strut submit DIR --to slurm|local [OPTIONS]",
      "Queues what the sweep in DIR still lacks: arrays of tasks of some minutes each. Submitting\n"
      "again queues only what is neither there nor queued. Tasks near their time limit finish the\n"
      "shard in hand and queue themselves again. `--to local` works through the tasks on this\n"
      "machine, in the background.",
      "  strut submit cars --to slurm --dry-run\n"
      "  strut submit cars --to slurm --partition short --time 30 --threads 8 --at-once 50\n"
      "  strut status cars\n  strut cancel cars");
  arguments.add_operand(ArgumentValue::folder("DIR"));
  arguments.add_option("to", ArgumentValue::one_of(list_dispatchers()), "who works through it");
  arguments.add_option("partition", "P", "of the cluster (default: the site's)");
  arguments.add_option("account", "A", "that pays");
  arguments.add_option("constraint", "C", "that nodes must meet");
  arguments.add_option("memory", "M", "of a task, as the site writes it: 4G");
  arguments.add_option("time", "T",
                       "wall clock of a task: minutes, HH:MM:SS or D-HH:MM:SS (default: twice what "
                       "it is expected to take)");
  arguments.add_option("threads", "N", "processors of a task (default 1; local: all)");
  arguments.add_option("minutes", "M", "what a task is to take (default 10)");
  arguments.add_option("tasks", "N", "at most N tasks in all");
  arguments.add_option("at-once", "N", "at most N tasks of an array run at once");
  arguments.add_list("option", "OPTION", "a further option for the scheduler, one word: --qos=low");
  arguments.add_option("scratch", ArgumentValue::folder("PATH"),
                       "node-local folder, $NAME and ${NAME} as the node has them, where each node "
                       "keeps a copy of the program");
  arguments.add_switch("shared",
                       "all nodes see DIR, though it lies on a disk of this machine (which serves "
                       "it to them)");
  arguments.add_switch("retry",
                       "behind the arrays, a task that tries failed cases once more, as `strut "
                       "resume` does");
  arguments.add_removed("no-merge", "nothing is merged without --merge");
  arguments.add_switch("merge", "a last task, behind all others, that writes DIR/merged.h5");
  arguments.add_switch("again",
                       "submit although it is unknown whether an earlier submission still runs");
  arguments.add_switch("dry-run", "print the scripts and what waits for what; queue nothing");
  arguments.add_switch("json", "print JSON");
  return arguments;
}

int run_submit(const Arguments& arguments) { return Submitter(arguments).run(); }

}  // namespace strut
