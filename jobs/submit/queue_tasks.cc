#include "jobs/submit/queue_tasks.h"

#include <fmt/format.h>

#include <iostream>

#include "base/text/quote_word.h"
#include "cluster/follow.h"
#include "io/file/atomic_file.h"
#include "jobs/cli/interrupt.h"
#include "jobs/cli/progress.h"

namespace strut {
namespace {

/// Refuses links in place of files that the tasks will write: a scheduler and bash follow them.
void prepare_folder(const SweepFolder& folder, bool merges) {
  const Folder root(folder.root);
  root.make_folder(folder.logs().filename().string());
  if (merges) check_regular(root.descriptor(), kMerged, root.path_of(kMerged));
}

/// Arrays wait for nothing; every other part waits for all parts before it.
template <class T>
std::vector<T> list_dependencies(const Submission& s, std::size_t part, const std::vector<T>& all) {
  const std::size_t count = part < s.arrays.size() ? 0 : part;
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

Submission make_submission_request(const OpenSweep& sweep, const TaskPlan& plan,
                                   const MissingWork& work, const SubmitRequest& request,
                                   const Dispatcher& dispatcher, const std::string& cluster) {
  Submission s;
  s.dispatcher = dispatcher.name();
  s.cluster_name = cluster;
  s.job_prefix = "strut-" + sweep.plan.hash().substr(0, 8);
  s.arrays = plan.arrays;
  s.retries = work.retries;
  s.collects = request.merges;
  return s;
}

QueuedSubmission queue_tasks(const OpenSweep& sweep, Submission submission,
                             const ScriptOptions& options, const Dispatcher& dispatcher) {
  const InterruptGuard guard;  // every queued job is also recorded
  prepare_folder(sweep.folder, submission.collects);
  dispatcher.dry_run(list_task_arrays(sweep.folder, submission, options).front());
  QueuedSubmission queued{make_submission(sweep.folder, std::move(submission)), {}};
  const Submission& s = queued.submission;
  const std::vector<TaskArray> tasks = list_task_arrays(sweep.folder, s, options);
  const std::vector<std::string> parts = s.list_parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string script = Submission::script_name(parts[i]);
    write_text_file(s.open(), script, dispatcher.make_script(tasks[i]));
    try {
      queued.jobs.push_back(
          dispatcher.submit(tasks[i], s.folder / script, list_dependencies(s, i, queued.jobs)));
    } catch (const EnvironmentError& e) {
      // The job may be queued nevertheless: its name finds it, so nothing is removed here.
      throw EnvironmentError(
          fmt::format("{}; {} of {} jobs are known to be queued; submit again for the others",
                      e.what(), queued.jobs.size(), parts.size()));
    }
    s.write_job(parts[i], queued.jobs.back());
    if (!s.is_cancelled()) continue;
    dispatcher.cancel(find_jobs(s, dispatcher));
    throw EnvironmentError(fmt::format("submission {}: cancelled meanwhile", s.name()));
  }
  return queued;
}

namespace {

/// The submission with the names that its next one would have.
Submission name_next(const OpenSweep& sweep, Submission s) {
  s.folder = sweep.folder.root / "jobs" / "NEXT";
  s.job_prefix += "-NEXT";
  return s;
}

}  // namespace

Json make_tasks_json(const OpenSweep& sweep, const Submission& submission,
                     const ScriptOptions& options, const Dispatcher& dispatcher,
                     bool asks_scheduler) {
  const Submission s = name_next(sweep, submission);
  const std::vector<TaskArray> tasks = list_task_arrays(sweep.folder, s, options);
  const std::vector<std::string> parts = s.list_parts();
  const std::string answer = asks_scheduler ? dispatcher.dry_run(tasks.front()) : "";
  Json list = Json::array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::vector<std::string> after = list_dependencies(s, i, parts);
    const std::filesystem::path script = s.folder / Submission::script_name(parts[i]);
    list.push_back(Json{{"part", parts[i]},
                        {"tasks", tasks[i].tasks},
                        {"after", after},
                        {"command", dispatcher.make_command(tasks[i], script, after)},
                        {"script", dispatcher.make_script(tasks[i])}});
  }
  return Json{{"to", dispatcher.name()}, {"scheduler_answer", answer}, {"parts", list}};
}

void print_tasks(const OpenSweep& sweep, const Submission& submission, const ScriptOptions& options,
                 const Dispatcher& dispatcher, bool asks_scheduler) {
  const Submission s = name_next(sweep, submission);
  const std::vector<TaskArray> tasks = list_task_arrays(sweep.folder, s, options);
  const std::vector<std::string> parts = s.list_parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::vector<std::string> command = dispatcher.make_command(
        tasks[i], s.folder / Submission::script_name(parts[i]), list_dependencies(s, i, parts));
    std::cout << fmt::format("\n--- {}\n$", s.job_name(parts[i]));
    for (const std::string& word : command) std::cout << " " << quote_if_needed(word);
    std::cout << "\n" << dispatcher.make_script(tasks[i]);
    const std::string answer = i == 0 && asks_scheduler ? dispatcher.dry_run(tasks[i]) : "";
    if (!answer.empty()) std::cout << fmt::format("({} says: {})\n", dispatcher.name(), answer);
  }
  std::cout << "\n";
  for (std::size_t i = 0; i < s.arrays.size(); ++i) {
    std::cout << fmt::format("{}: shards {} to {}, {} tasks\n", parts[i], s.arrays[i].shards.first,
                             s.arrays[i].shards.end - 1, format_count(s.arrays[i].tasks()));
  }
  for (std::size_t i = s.arrays.size(); i < parts.size(); ++i) {
    std::cout << fmt::format("{}: after all parts above, however they end (afterany)\n", parts[i]);
  }
  std::cout << "nothing is queued\n";
}

void print_commands(const OpenSweep& sweep, const TaskPlan& plan, const MissingWork& work,
                    const SubmitRequest& request) {
  const std::string root = quote_if_needed(sweep.folder.root.string());
  const std::string threads = fmt::format(" --threads {}", request.resources.threads);
  for (const PackedArray& array : plan.arrays) {
    for (std::int64_t task = 0; task < array.tasks(); ++task) {
      const ShardRange shards = array.get_task(task);
      std::cout << fmt::format("strut run {}{} --shards {}:{}\n", root, threads, shards.first,
                               shards.end);
    }
  }
  if (work.retries) std::cout << fmt::format("strut resume {}{}\n", root, threads);
  if (request.merges) {
    const std::string merged = quote_if_needed((sweep.folder.root / kMerged).string());
    std::cout << fmt::format("strut merge {} -o {} --force\n", root, merged);
  }
}

}  // namespace strut
