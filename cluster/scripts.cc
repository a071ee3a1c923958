#include "cluster/scripts.h"

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/quote_word.h"
#include "cluster/task_run.h"

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

/// Of the $NAME or ${NAME} that the text begins with; 0: it begins with neither.
std::size_t measure_variable(const std::string& text) {
  constexpr char kDigits[] = "0123456789";
  constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
  const bool is_braced = text.starts_with("${");
  const std::size_t first = is_braced ? 2 : 1;
  const std::size_t end = std::min(text.find_first_not_of(kLetters, first), text.size());
  if (end <= first || text.find_first_of(kDigits, first) == first) return 0;
  if (!is_braced) return end;
  return end < text.size() && text[end] == '}' ? end + 1 : 0;
}

}  // namespace

void check_scratch(const std::string& scratch) {
  bool is_safe = !has_control_character(scratch) &&
                 scratch.find_first_of("`\"\\") == std::string::npos &&
                 (scratch.starts_with('/') || scratch.starts_with('$'));
  for (std::size_t i = scratch.find('$'); is_safe && i < scratch.size();
       i = scratch.find('$', i + 1)) {
    is_safe = measure_variable(scratch.substr(i)) > 0;
  }
  if (is_safe) return;
  throw InputError("--scratch " + quote_if_needed(scratch) +
                   ": must be an absolute folder, with no more for bash to expand than $NAME and "
                   "${NAME}, and without quotes and backslashes, as in '/local/$USER'");
}

std::vector<TaskArray> list_task_arrays(const SweepFolder& folder, const Submission& submission,
                                        const ScriptOptions& options) {
  std::vector<TaskArray> all;
  const std::string root = quote_word(folder.root.string());
  const auto add_task = [&](const std::string& part, const std::string& words) -> TaskArray& {
    TaskArray task;
    task.name = submission.job_name(part);
    task.preparation = make_preparation(options.scratch);
    task.program = "\"$program\" " + words;
    task.is_array = false;
    task.resources = options.resources;
    task.folder = folder.logs();
    task.mark = make_job_mark(folder.root, task.name);
    all.push_back(std::move(task));
    return all.back();
  };
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    TaskArray& array =
        add_task(submission.array_name(i), "run " + root + " --threads \"$threads\" --task " +
                                               make_task_name(submission.name(), i, "\"$task\""));
    array.is_array = true;
    array.tasks = submission.arrays[i].tasks();
    array.at_once = options.at_once;
  }
  if (submission.retries) {
    add_task(Submission::kRetry, "resume " + root + " --threads \"$threads\"");
  }
  if (submission.collects) {
    add_task(Submission::kCollect,
             "merge " + root + " -o " + quote_word((folder.root / kMerged).string()) + " --force");
  }
  return all;
}

}  // namespace strut
