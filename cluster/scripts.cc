#include "cluster/scripts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/quote_word.h"
#include "cluster/task_run.h"

namespace strut {
namespace {

/// Returns the lines that set $program to this program or to a node's copy of it. Only an identical
/// copy that this user owns is trusted: others may write to a node's folder as well.
std::vector<std::string> make_preparation(const ScriptOptions& options) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> lines = {"program=" + quote_word(program)};
  if (!options.prologue.empty()) {
    // Scripts of sites read variables that are not set.
    lines.emplace_back("launcher=(); set +u");
    lines.push_back(options.prologue);
    lines.emplace_back("set -u");
  }
  const std::string& scratch = options.scratch;
  if (scratch.empty()) return lines;
  lines.push_back(fmt::format("set +u; copy=\"{}/strut-$UID\"; set -u", scratch));
  lines.emplace_back(
      "is_ours() { [[ -O $copy && -x $copy && ! -L $copy ]] && cmp -s \"$program\" \"$copy\"; }");
  lines.emplace_back(
      "is_ours || { cp \"$program\" \"$copy.$$\" && mv -f \"$copy.$$\" \"$copy\"; } || rm -f "
      "\"$copy.$$\"");
  lines.emplace_back("is_ours && program=$copy");
  return lines;
}

/// Returns the length of the $NAME or ${NAME} at the beginning of the text; 0 if there is none.
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
  throw InputError(fmt::format(
      "--scratch {}: must be an absolute folder without quotes and backslashes, in which "
      "bash expands only $NAME and ${{NAME}}, such as '/local/$USER'",
      quote_if_needed(scratch)));
}

std::vector<TaskArray> list_task_arrays(const SweepFolder& folder, const Submission& submission,
                                        const ScriptOptions& options) {
  const std::string root = quote_word(folder.root.string());
  const auto make_task = [&](const std::string& part, const std::string& command) {
    TaskArray task;
    task.name = submission.job_name(part);
    task.preparation = make_preparation(options);
    const char* const launcher = options.prologue.empty() ? "" : "\"${launcher[@]}\" ";
    task.program = fmt::format("{}\"$program\" {}", launcher, command);
    task.is_array = false;
    task.resources = options.resources;
    task.folder = folder.logs();
    task.mark = make_job_mark(folder.root, task.name);
    return task;
  };
  std::vector<TaskArray> all;
  for (std::size_t i = 0; i < submission.arrays.size(); ++i) {
    const std::string task = make_task_name(submission.name(), i, "\"$task\"");
    TaskArray& array = all.emplace_back(
        make_task(submission.array_name(i),
                  fmt::format("run {} --threads \"$threads\" --task {}", root, task)));
    array.is_array = true;
    array.tasks = submission.arrays[i].tasks();
    array.at_once = options.at_once;
  }
  if (submission.retries) {
    all.push_back(
        make_task(Submission::kRetry, fmt::format("resume {} --threads \"$threads\"", root)));
  }
  if (submission.collects) {
    const std::string merged = quote_word((folder.root / kMerged).string());
    all.push_back(
        make_task(Submission::kCollect, fmt::format("merge {} -o {} --force", root, merged)));
  }
  return all;
}

}  // namespace strut
