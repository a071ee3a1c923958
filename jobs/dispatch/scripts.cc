#include "jobs/dispatch/scripts.h"

#include "jobs/dispatch/quote_word.h"
#include "jobs/dispatch/task_run.h"

namespace strut {
namespace {

/// The lines that set $program: this one, or a node's own copy of it. Only a copy that is the same
/// and our own is trusted: others may write to a node's folder, too.
std::vector<std::string> make_preparation(const std::string& scratch) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> lines = {"program=" + quote_word(program)};
  if (scratch.empty()) return lines;
  lines.push_back("set +u; copy=\"" + scratch + "/strut-$UID\"; set -u");
  lines.emplace_back(
      "is_ours() { [[ -O $copy && -x $copy && ! -L $copy ]] && cmp -s \"$program\" \"$copy\"; }");
  lines.emplace_back(
      "is_ours || { cp \"$program\" \"$copy.$$\" && mv -f \"$copy.$$\" \"$copy\"; } || rm -f "
      "\"$copy.$$\"");
  lines.emplace_back("is_ours && program=$copy");
  return lines;
}

}  // namespace

std::vector<std::string> make_scripts(const Dispatcher& dispatcher, const SweepFolder& folder,
                                      const Submission& submission, const ScriptOptions& options) {
  std::vector<std::string> scripts;
  const std::string root = quote_word(folder.root.string());
  const auto make_task = [&](const std::string& part, const std::string& words) {
    TaskArray task;
    task.name = submission.job_name(part);
    task.preparation = make_preparation(options.scratch);
    task.program = "\"$program\" " + words;
    task.is_array = false;
    task.resources = options.resources;
    task.folder = folder.logs();
    return task;
  };
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    TaskArray array =
        make_task(submission.array_name(i), "run " + root + " --threads \"$threads\" --task " +
                                                make_task_name(submission.name(), i, "\"$task\""));
    array.is_array = true;
    array.tasks = submission.arrays[i].tasks();
    array.at_once = options.at_once;
    scripts.push_back(dispatcher.make_script(array));
  }
  if (submission.retries) {
    scripts.push_back(dispatcher.make_script(
        make_task(Submission::kRetry, "resume " + root + " --threads \"$threads\"")));
  }
  if (submission.collects) {
    const std::string merged = quote_word((folder.root / "merged.h5").string());
    scripts.push_back(dispatcher.make_script(
        make_task(Submission::kCollect, "merge " + root + " -o " + merged + " --force")));
  }
  return scripts;
}

}  // namespace strut
