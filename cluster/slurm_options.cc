#include "cluster/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "base/error/input_error.h"
#include "cluster/slurm.h"

namespace strut::slurm {
namespace {

/// Returns the --output of sbatch, the file that a task's output is appended to. Slurm replaces %a
/// and the like by numbers, except in a path with a backslash, which it treats as an escape: in
/// such a folder all tasks of an array write to one file.
std::string make_output_pattern(const TaskArray& tasks) {
  const std::string path = (tasks.folder / tasks.name).string();
  const bool is_literal = path.find('\\') != std::string::npos;
  const char special = is_literal ? '\\' : '%';
  std::string pattern;
  for (const char c : path) pattern.append(c == special ? 2 : 1, c);
  return fmt::format("{}{}.log", pattern, tasks.is_array && !is_literal ? "-%a" : "");
}

/// Returns whether sbatch takes the option for one by which strut numbers and finds its jobs or
/// learns their numbers; sbatch also accepts abbreviated names.
bool is_reserved(const std::string& option) {
  static constexpr std::array<const char*, 8> kNames = {"--array",    "--clusters", "--comment",
                                                        "--job-name", "--parsable", "--test-only",
                                                        "--wait",     "--wrap"};
  const std::string name = option.substr(0, option.find('='));
  if (!name.starts_with("--")) return std::string("aJMW").find(option[1]) != std::string::npos;
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const std::string& reserved) { return reserved.starts_with(name); });
}

void check_option(const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  const bool is_option = name.size() > 1 && name.front() == '-' && name != "--" &&
                         name.find_first_of(" \t\n") == std::string::npos;
  if (!is_option) {
    throw InputError(
        fmt::format("--option {}: must be one option, as in --option='--qos=low'", option));
  }
  if (is_reserved(option)) {
    throw InputError(
        fmt::format("--option {}: reserved for strut, which finds its jobs by it; to use "
                    "another cluster, submit from there",
                    option));
  }
}

}  // namespace

std::vector<std::string> list_options(const TaskArray& tasks) {
  const Resources& r = tasks.resources;
  std::vector<std::string> options = {"--job-name=" + tasks.name, "--comment=" + tasks.mark};
  const auto set_given = [&](const char* option, const std::string& value) {
    if (!value.empty()) options.push_back(fmt::format("{}={}", option, value));
  };
  if (tasks.is_array) {
    const std::string throttle = tasks.at_once > 0 ? fmt::format("%{}", tasks.at_once) : "";
    options.push_back(fmt::format("--array=0-{}{}", tasks.tasks - 1, throttle));
  }
  options.insert(options.end(),
                 {"--output=" + make_output_pattern(tasks), "--open-mode=append", "--requeue",
                  "--ntasks=1", fmt::format("--cpus-per-task={}", r.threads)});
  if (r.seconds > 0.0) options.push_back("--time=" + format_slurm_time(r.seconds));
  if (r.warning > 0.0) {
    options.push_back(fmt::format("--signal=B:USR1@{}", std::lround(r.warning)));
  }
  set_given("--partition", r.partition);
  set_given("--account", r.account);
  set_given("--constraint", r.constraint);
  set_given("--mem", r.memory);
  options.insert(options.end(), r.extra.begin(), r.extra.end());
  return options;
}

void check_words(const Resources& resources) {
  static const std::regex kMemory("[0-9]+[KMGTkmgt]?[Bb]?");
  if (!resources.memory.empty() && !std::regex_match(resources.memory, kMemory)) {
    throw InputError(fmt::format("--memory {}: must be a number, in MB or with K, M, G or T, as 4G",
                                 resources.memory));
  }
  for (const std::string& option : resources.extra) check_option(option);
}

std::string make_script(const TaskArray& tasks) {
  std::string text = "#!/bin/bash\nset -u\ntask=${SLURM_ARRAY_TASK_ID:-0}\n";
  text += fmt::format("threads=${{SLURM_CPUS_PER_TASK:-{}}}\n", tasks.resources.threads);
  for (const std::string& line : tasks.preparation) text += line + "\n";
  // Slurm warns the batch shell only: the program takes its place.
  return text + fmt::format("exec {}\n", tasks.program);
}

}  // namespace strut::slurm
