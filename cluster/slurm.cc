#include "cluster/slurm.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <set>
#include <sstream>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "base/text/parse_number.h"
#include "cluster/file_system.h"
#include "cluster/record_file.h"
#include "cluster/submission.h"
#include "io/file/run_child.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// A command of Slurm's. What the environment would set in place of our options, or hide from its
/// answers, is kept from it.
ChildOutput call(const std::vector<std::string>& words) {
  ChildOptions options;
  options.hidden_variables = {"SBATCH_", "SQUEUE_", "SINFO_", "SCANCEL_", "SLURM_CLUSTERS="};
  return read_child(words, options);
}

/// Throws EnvironmentError where the command fails.
std::string ask(const std::vector<std::string>& words) {
  const ChildOutput output = call(words);
  if (output.code != 0) throw EnvironmentError(words.front() + ": " + output.explain());
  return output.out;
}

/// "MaxArraySize            = 1001" of `scontrol show config`.
std::map<std::string, std::string> read_settings() {
  std::map<std::string, std::string> settings;
  for (const std::string& line : split(ask({"scontrol", "show", "config"}), '\n')) {
    std::istringstream words(line);
    std::string key, equals, value;
    if (words >> key >> equals >> value && equals == "=") settings[key] = value;
  }
  return settings;
}

std::int64_t read_count(const std::map<std::string, std::string>& settings,
                        const std::string& key) {
  const auto found = settings.find(key);
  if (found == settings.end()) return SiteLimits().tasks;
  return parse_number<std::int64_t>(found->second).value_or(SiteLimits().tasks);
}

/// max_array_tasks of SchedulerParameters, where a site sets it.
std::int64_t read_most_tasks(const std::map<std::string, std::string>& settings) {
  const auto found = settings.find("SchedulerParameters");
  const std::string before = "max_array_tasks=";
  const std::size_t at = found == settings.end() ? std::string::npos : found->second.find(before);
  if (at == std::string::npos) return SiteLimits().tasks;
  const std::string value = found->second.substr(at + before.size());
  return parse_number<std::int64_t>(value.substr(0, value.find(','))).value_or(SiteLimits().tasks);
}

struct Partition {
  std::string name;
  double seconds = 0.0;
  bool is_up = false;
};

/// The one that is named, or the site's own choice. Throws InputError.
Partition find_partition(const std::string& wanted) {
  std::vector<std::string> names;
  for (const std::string& line : split(ask({"sinfo", "-a", "-h", "-o", "%P|%l|%a"}), '\n')) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() != 3) continue;
    Partition partition{parts[0], parse_slurm_time(parts[1]).value_or(SiteLimits().seconds),
                        parts[2] == "up"};
    const bool is_default = !partition.name.empty() && partition.name.back() == '*';
    if (is_default) partition.name.pop_back();
    if (wanted.empty() ? is_default : partition.name == wanted) return partition;
    names.push_back(partition.name);
  }
  if (wanted.empty()) {
    throw InputError("--partition: this site has no default; partitions: " + join_names(names));
  }
  throw InputError("--partition " + wanted + ": does not exist" + suggest_name(wanted, names) +
                   "; partitions: " + join_names(names));
}

std::string find_host() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string name = host.data();
  return name.substr(0, name.find('.'));
}

/// Throws InputError where nodes of the partition are other machines and the folder is on a disk of
/// this one.
void check_folder(const std::string& partition, const fs::path& folder) {
  const std::string kind = find_local_file_system(folder);
  if (kind.empty()) return;
  const std::string here = find_host();
  std::set<std::string> others;
  for (const std::string& node :
       split(ask({"sinfo", "-h", "-N", "-p", partition, "-O", "NodeHost:256"}), '\n')) {
    const std::string host = node.substr(0, node.find_first_of(". "));
    if (!host.empty() && host != here) others.insert(host);
  }
  if (others.empty()) return;
  throw InputError(folder.string() + ": lies on a file system of this machine alone (" + kind +
                   "); the nodes of partition " + partition + " (" + *others.begin() +
                   (others.size() > 1 ? ", ..." : "") +
                   ") cannot see it; put the sweep where all see it, such as your home, or say "
                   "--shared where they do see it");
}

const char* read_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// "123_4" of the task that this process is; "123" of a job that is no array; "".
std::string find_own_job() {
  const std::string array = read_environment("SLURM_ARRAY_JOB_ID");
  if (array.empty()) return read_environment("SLURM_JOB_ID");
  return array + "_" + read_environment("SLURM_ARRAY_TASK_ID");
}

/// A word of a later Slurm's is not taken for an end.
TaskState find_state(const std::string& word) {
  static const std::set<std::string> pending = {"PENDING",      "CONFIGURING",  "REQUEUED",
                                                "REQUEUE_FED",  "REQUEUE_HOLD", "SPECIAL_EXIT",
                                                "RESV_DEL_HOLD"};
  static const std::set<std::string> ended = {
      "BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE", "FAILED", "LAUNCH_FAILED",
      "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY", "REVOKED",  "TIMEOUT"};
  if (pending.count(word) > 0) return TaskState::kPending;
  return ended.count(word) > 0 ? TaskState::kEnded : TaskState::kRunning;
}

/// Lines of `squeue -r -o %F|%K|%T|%r|%k|%j` about these jobs.
QueueAnswer parse_queue(const std::string& text, const std::vector<JobRecord>& jobs) {
  std::map<std::string, const JobRecord*> records;
  for (const JobRecord& record : jobs) records[record.job] = &record;
  QueueAnswer answer;
  for (const std::string& line : split(text, '\n')) {
    const std::vector<std::string> parts = split(line, '|');
    if (parts.size() < 6) continue;
    const auto found = records.find(parts[0]);
    if (found == records.end() || found->second->name != parts[5]) continue;
    if (found->second->mark != parts[4]) {
      return {{}, describe_foreign("job " + parts[0], parts[5])};
    }
    answer.tasks.push_back({parts[0], parse_number<std::int64_t>(parts[1]).value_or(-1), 1,
                            find_state(parts[2]), parts[2], parts[3]});
  }
  return answer;
}

/// Whether the text of `scontrol show job` has a field of that value.
bool has_field(const std::string& text, const std::string& field) {
  const std::size_t at = text.find(field);
  return at != std::string::npos &&
         (at + field.size() == text.size() ||
          std::isspace(static_cast<unsigned char>(text[at + field.size()])) != 0);
}

/// The file that a task's output is appended to, as sbatch is to be told. Slurm puts numbers in
/// place of %a and the like; where it meets a backslash, which it takes for an escape, it does not:
/// in such a folder all tasks of an array write to one file.
std::string make_output_pattern(const TaskArray& tasks) {
  const std::string path = (tasks.folder / tasks.name).string();
  const bool is_literal = path.find('\\') != std::string::npos;
  const char special = is_literal ? '\\' : '%';
  std::string pattern;
  for (const char c : path) pattern.append(c == special ? 2 : 1, c);
  return pattern + (tasks.is_array && !is_literal ? "-%a" : "") + ".log";
}

/// The options of sbatch. As arguments they are words, whatever is in them; in the script they
/// would be lines that Slurm takes apart.
std::vector<std::string> list_options(const TaskArray& tasks) {
  const Resources& r = tasks.resources;
  std::vector<std::string> options = {"--job-name=" + tasks.name, "--comment=" + tasks.mark};
  const auto set_given = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) options.push_back(option + "=" + value);
  };
  if (tasks.is_array) {
    const std::string throttle = tasks.at_once > 0 ? "%" + std::to_string(tasks.at_once) : "";
    options.push_back("--array=0-" + std::to_string(tasks.tasks - 1) + throttle);
  }
  options.insert(options.end(),
                 {"--output=" + make_output_pattern(tasks), "--open-mode=append", "--requeue",
                  "--ntasks=1", "--cpus-per-task=" + std::to_string(r.threads)});
  if (r.seconds > 0.0) options.push_back("--time=" + format_slurm_time(r.seconds));
  if (r.warning > 0.0) {
    options.push_back("--signal=B:USR1@" + std::to_string(std::lround(r.warning)));
  }
  set_given("--partition", r.partition);
  set_given("--account", r.account);
  set_given("--constraint", r.constraint);
  set_given("--mem", r.memory);
  options.insert(options.end(), r.extra.begin(), r.extra.end());
  return options;
}

/// Whether sbatch takes the option for one by which strut numbers and finds its jobs, or gets their
/// numbers: also a name of which only the beginning is written.
bool is_reserved(const std::string& option) {
  static constexpr std::array<const char*, 8> kNames = {"--array",    "--clusters", "--comment",
                                                        "--job-name", "--parsable", "--test-only",
                                                        "--wait",     "--wrap"};
  const std::string name = option.substr(0, option.find('='));
  if (!name.starts_with("--")) return std::string("aJMW").find(option[1]) != std::string::npos;
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](const std::string& reserved) { return reserved.starts_with(name); });
}

/// Of --option. Throws InputError.
void check_option(const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  const bool is_option = name.size() > 1 && name.front() == '-' && name != "--" &&
                         name.find_first_of(" \t\n") == std::string::npos;
  if (!is_option) {
    throw InputError("--option " + option + ": must be one option, as in --option='--qos=low'");
  }
  if (is_reserved(option)) {
    throw InputError("--option " + option +
                     ": must be left to strut, which finds its jobs by it; for another cluster, "
                     "submit there");
  }
}

/// Throws InputError where a record's job is no number of Slurm's.
void check_number(const JobRecord& record) {
  const bool is_number = !record.job.empty() && record.job.size() <= 10 &&
                         record.job.find_first_not_of("0123456789") == std::string::npos;
  if (is_number) return;
  throw InputError(record.file.string() + ": must hold the number of a job" + kRecordRemedy);
}

}  // namespace

std::optional<double> parse_slurm_time(const std::string& text) {
  if (text == "infinite" || text == "UNLIMITED") return SiteLimits().seconds;
  const std::size_t dash = text.find('-');
  const bool has_days = dash != std::string::npos;
  const auto days = parse_number<double>(has_days ? text.substr(0, dash) : "0");
  std::vector<double> parts;
  for (const std::string& part : split(has_days ? text.substr(dash + 1) : text, ':')) {
    const auto number = parse_number<double>(part);
    if (!number || *number < 0.0) return std::nullopt;
    parts.push_back(*number);
  }
  if (!days || parts.empty() || parts.size() > 3) return std::nullopt;
  // Without days: minutes; minutes:seconds; hours:minutes:seconds. With: hours first.
  const std::size_t first = has_days || parts.size() == 3 ? 0 : 1;
  constexpr std::array<double, 3> kSeconds = {3600.0, 60.0, 1.0};
  double seconds = 86400.0 * *days;
  for (std::size_t i = 0; i < parts.size(); ++i) seconds += kSeconds[first + i] * parts[i];
  return seconds;
}

std::string format_slurm_time(double seconds) {
  const auto minutes = static_cast<long>(std::ceil(seconds / 60.0));
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%ld-%02ld:%02ld:00", minutes / 1440, minutes / 60 % 24,
                minutes % 60);
  return text.data();
}

bool SlurmDispatcher::is_there() { return call({"sbatch", "--version"}).code == 0; }

std::string SlurmDispatcher::find_place() const { return read_settings()["ClusterName"]; }

SiteLimits SlurmDispatcher::check(const Resources& resources, const fs::path& folder) const {
  const ChildOutput there = call({"sbatch", "--version"});
  if (there.code != 0) {
    throw EnvironmentError("sbatch: " + there.explain() +
                           "; --to slurm works where Slurm's commands are in PATH, --to "
                           "local everywhere");
  }
  for (const std::string& option : resources.extra) check_option(option);
  const auto settings = read_settings();
  const Partition partition = find_partition(resources.partition);
  if (!partition.is_up) {
    throw InputError("--partition " + partition.name +
                     ": is down, as sinfo says; name another, or wait");
  }
  if (resources.seconds > partition.seconds) {
    throw InputError("--time " + format_slurm_time(resources.seconds) +
                     ": must be at most the partition's, " + format_slurm_time(partition.seconds));
  }
  if (!resources.is_shared) check_folder(partition.name, folder);
  const std::string queue = ask({"squeue", "-h", "-a", "-r", "-o", "%A"});
  const std::int64_t queued = std::count(queue.begin(), queue.end(), '\n');
  constexpr std::int64_t kSingleJobs = 2;  // behind the arrays
  const std::int64_t array_tasks =
      std::min(read_count(settings, "MaxArraySize"), read_most_tasks(settings));
  if (array_tasks <= 0)
    throw EnvironmentError(
        "MaxArraySize: this site allows no job arrays; a job of your own with `strut run DIR` does "
        "the "
        "same");
  return {array_tasks,
          std::max<std::int64_t>(1, read_count(settings, "MaxJobCount") - queued - kSingleJobs),
          partition.seconds};
}

Findings SlurmDispatcher::examine(const Resources& resources, const fs::path& folder) const {
  constexpr double kSlow = 5.0;  // s
  if (!is_there())
    return {{"scheduler", Health::kBad, "sbatch cannot be started", "--to local works"}};
  Findings findings;
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, std::string> settings;
  try {
    settings = read_settings();
  } catch (const EnvironmentError& e) {
    return {{"scheduler", Health::kBad, e.what(), "nothing can be submitted right now"}};
  }
  const double waited =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  findings.push_back({"scheduler", waited < kSlow ? Health::kGood : Health::kWarning,
                      "Slurm " + settings["SLURM_VERSION"] + ", answers in " +
                          format_rounded(std::round(1e3 * waited)) + " ms",
                      ""});
  findings.push_back(
      {"job arrays", Health::kGood,
       settings["MaxArraySize"] + " tasks an array, " + settings["MaxJobCount"] + " jobs at once",
       "submissions are split at that"});
  const bool requeues = settings["JobRequeue"] != "0";
  findings.push_back({"requeue", requeues ? Health::kGood : Health::kWarning,
                      requeues ? "allowed" : "not allowed by the site",
                      requeues ? "tasks go on after a drained time limit or a failed node"
                               : "submit again for what a time limit or a failed node left"});
  try {
    const Partition partition = find_partition(resources.partition);
    findings.push_back(
        {"partition", partition.is_up ? Health::kGood : Health::kBad,
         partition.name + (partition.is_up ? ", up" : ", down") + ", " +
             (std::isfinite(partition.seconds) ? format_slurm_time(partition.seconds) + " a task"
                                               : std::string("no time limit")),
         ""});
    check_folder(partition.name, folder);
    findings.push_back({"folder on the nodes", Health::kGood, "may be seen", ""});
  } catch (const InputError& e) {
    findings.push_back({"partition", Health::kBad, e.what(), "nothing can run there"});
  }
  return findings;
}

std::vector<NodeAnswer> SlurmDispatcher::ask_nodes(const Resources& resources) const {
  const Partition partition = find_partition(resources.partition);
  const std::string idle =
      ask({"sinfo", "-h", "-N", "-p", partition.name, "-t", "idle", "-o", "%N"});
  const auto count = std::count(idle.begin(), idle.end(), '\n');
  if (count == 0) return {};
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const std::string told =
      ask({"srun", "--partition=" + partition.name, "--nodes=" + std::to_string(count),
           "--ntasks-per-node=1", "--immediate=30", "--quiet", "bash", "-c",
           "echo \"$SLURMD_NODENAME|$(\"$0\" --version)\" | tr '\\n' ' '; echo", program});
  std::vector<NodeAnswer> nodes;
  const std::string before = "instruction sets: ";
  for (const std::string& line : split(told, '\n')) {
    const std::size_t bar = line.find('|'), sets = line.find(before);
    if (bar == std::string::npos || sets == std::string::npos) continue;
    nodes.push_back({line.substr(0, bar), line.substr(sets + before.size())});
  }
  return nodes;
}

std::string SlurmDispatcher::make_script(const TaskArray& tasks) const {
  std::string text = "#!/bin/bash\nset -u\ntask=${SLURM_ARRAY_TASK_ID:-0}\n";
  text += "threads=${SLURM_CPUS_PER_TASK:-" + std::to_string(tasks.resources.threads) + "}\n";
  for (const std::string& line : tasks.preparation) text += line + "\n";
  // Slurm's warning goes to the batch shell alone: the program takes its place.
  return text + "exec " + tasks.program + "\n";
}

std::vector<std::string> SlurmDispatcher::make_command(
    const TaskArray& tasks, const fs::path& script, const std::vector<std::string>& after) const {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  for (const std::string& option : list_options(tasks)) words.push_back(option);
  if (!after.empty()) {
    words.emplace_back("--dependency=afterany");
    for (const std::string& job : after) words.back() += ":" + job;
  }
  words.push_back(script.string());
  return words;
}

std::string SlurmDispatcher::try_tasks(const TaskArray& tasks) const {
  std::vector<std::string> words = {"sbatch", "--test-only", "--wrap=:"};
  for (const std::string& option : list_options(tasks)) words.push_back(option);
  const ChildOutput output = call(words);
  if (output.code == ChildOutput::kNotStarted) return "";
  if (output.code != 0) throw EnvironmentError("sbatch: " + output.explain());
  return output.explain();
}

std::string SlurmDispatcher::submit(const TaskArray& tasks, const fs::path& script,
                                    const std::vector<std::string>& after) const {
  const std::vector<std::string> words = make_command(tasks, script, after);
  const std::string answer = ask(words);  // "123" or "123;cluster"
  std::string job = answer.substr(0, answer.find_first_of(";\n"));
  if (!parse_number<std::int64_t>(job))
    throw EnvironmentError("sbatch: said '" + answer +
                           "', no job's number; `squeue` tells whether it is queued");
  return job;
}

std::string SlurmDispatcher::find_job(const JobRecord& record) const {
  const std::string jobs =
      ask({"squeue", "-h", "-a", "--me", "-t", "all", "--name", record.name, "-o", "%F|%k"});
  for (const std::string& line : split(jobs, '\n')) {
    if (line.ends_with("|" + record.mark)) return line.substr(0, line.find('|'));
  }
  return "";
}

QueueAnswer SlurmDispatcher::query(const std::vector<JobRecord>& jobs) const {
  std::for_each(jobs.begin(), jobs.end(), &check_number);
  const ChildOutput output =
      call({"squeue", "-h", "-a", "-r", "--me", "-t", "all", "-o", "%F|%K|%T|%r|%k|%j"});
  if (output.code != 0) return {{}, "squeue: " + output.explain()};
  QueueAnswer answer = parse_queue(output.out, jobs);
  if (!answer.silence.empty()) return answer;
  // What squeue passes over has ended only where the controller says that there is no such job, or
  // that the number is another's.
  for (const JobRecord& record : jobs) {
    const bool is_listed = std::any_of(answer.tasks.begin(), answer.tasks.end(),
                                       [&](const QueuedTasks& t) { return t.job == record.job; });
    if (is_listed) continue;
    const ChildOutput known = call({"scontrol", "show", "job", record.job});
    const bool is_gone =
        known.code != 0 && (known.out + known.messages).find("Invalid job id") != std::string::npos;
    const bool is_named_so = has_field(known.out, "JobName=" + record.name);
    if (is_gone || (known.code == 0 && !is_named_so)) continue;
    if (known.code == 0 && !has_field(known.out, "Comment=" + record.mark)) {
      return {{}, describe_foreign("job " + record.job, record.name)};
    }
    return {{},
            "squeue does not list job " + record.job + ", and scontrol " +
                (known.code == 0 ? "knows it" : "says: " + known.explain())};
  }
  return answer;
}

void SlurmDispatcher::cancel(const std::vector<JobRecord>& jobs) const {
  const QueueAnswer answer = query(jobs);
  if (!answer.silence.empty()) {
    throw EnvironmentError(answer.silence + "; nothing is cancelled, scancel does it by hand");
  }
  // Root may cancel anybody's jobs, and a number may be another's by now.
  const std::string mine = "--user=" + find_user();
  for (const JobRecord& record : jobs) {
    const bool is_queued = std::any_of(
        answer.tasks.begin(), answer.tasks.end(),
        [&](const auto& t) { return t.job == record.job && t.state != TaskState::kEnded; });
    if (is_queued) ask({"scancel", mine, "--name=" + record.name, record.job});
  }
}

bool SlurmDispatcher::requeue_own() const {
  const std::string job = find_own_job();
  return !job.empty() && call({"scontrol", "requeue", job}).code == 0;
}

std::int64_t SlurmDispatcher::find_own_end() const {
  // Slurm before 22.05.9 does not put it into the task's environment.
  const auto told = parse_number<std::int64_t>(read_environment("SLURM_JOB_END_TIME"));
  if (told) return *told;
  const std::string job = read_environment("SLURM_JOB_ID");
  if (job.empty()) return 0;
  const ChildOutput left = call({"squeue", "-h", "-a", "-j", job, "-o", "%L"});
  const auto seconds = parse_slurm_time(left.out.substr(0, left.out.find('\n')));
  const bool is_known = left.code == 0 && seconds && std::isfinite(*seconds);
  return is_known ? std::time(nullptr) + std::lround(*seconds) : 0;
}

int SlurmDispatcher::count_own_restarts() const {
  return parse_number<int>(read_environment("SLURM_RESTART_COUNT")).value_or(0);
}

}  // namespace strut
