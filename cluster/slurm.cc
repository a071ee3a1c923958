#include "cluster/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <set>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"
#include "cluster/record_file.h"
#include "cluster/slurm_commands.h"
#include "cluster/slurm_options.h"
#include "cluster/slurm_site.h"
#include "cluster/submission.h"
#include "io/file/run_child.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using slurm::ask;
using slurm::call;
using slurm::split;

const char* read_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Returns "123_4" for the task of this process, "123" if its job is not an array, or "".
std::string find_own_job() {
  const std::string array = read_environment("SLURM_ARRAY_JOB_ID");
  if (array.empty()) return read_environment("SLURM_JOB_ID");
  return fmt::format("{}_{}", array, read_environment("SLURM_ARRAY_TASK_ID"));
}

/// Interprets a state of Slurm's. Unknown states, of later versions, do not count as ended.
TaskState find_state(const std::string& name) {
  static const std::set<std::string> pending = {"PENDING",      "CONFIGURING",  "REQUEUED",
                                                "REQUEUE_FED",  "REQUEUE_HOLD", "SPECIAL_EXIT",
                                                "RESV_DEL_HOLD"};
  static const std::set<std::string> ended = {
      "BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE", "FAILED", "LAUNCH_FAILED",
      "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY", "REVOKED",  "TIMEOUT"};
  if (pending.contains(name)) return TaskState::kPending;
  return ended.contains(name) ? TaskState::kEnded : TaskState::kRunning;
}

std::string name_job(const std::string& job) { return fmt::format("job {}", job); }

constexpr char kQueueFormat[] = "%F|%K|%T|%r|%k|%j";

/// Parses the lines of squeue in kQueueFormat about these jobs.
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
      return {{}, describe_foreign(name_job(parts[0]), parts[5])};
    }
    answer.tasks.push_back({parts[0], parse_number<std::int64_t>(parts[1]).value_or(-1), 1,
                            find_state(parts[2]), parts[2], parts[3]});
  }
  return answer;
}

/// Returns whether the text of `scontrol show job` has the field, "KEY=value".
bool has_field(const std::string& text, const std::string& field) {
  const std::size_t at = text.find(field);
  return at != std::string::npos &&
         (at + field.size() == text.size() ||
          std::isspace(static_cast<unsigned char>(text[at + field.size()])) != 0);
}

/// Throws InputError unless the job of a record is a number of Slurm's.
void check_number(const JobRecord& record) {
  const bool is_number = !record.job.empty() && record.job.size() <= 10 &&
                         record.job.find_first_not_of("0123456789") == std::string::npos;
  if (is_number) return;
  throw InputError(
      fmt::format("{}: must hold the number of a job; {}", record.file.string(), kRecordRemedy));
}

/// Returns why a job that squeue does not list may still run; "" if it has ended: if the controller
/// reports that there is no such job, or that its number belongs to another job.
std::string find_doubt(const JobRecord& record) {
  const ChildOutput known = call({"scontrol", "show", "job", record.job});
  const bool is_gone =
      known.code != 0 && (known.out + known.messages).find("Invalid job id") != std::string::npos;
  const bool has_name = has_field(known.out, "JobName=" + record.name);
  if (is_gone || (known.code == 0 && !has_name)) return "";
  if (known.code == 0 && !has_field(known.out, "Comment=" + record.mark)) {
    return describe_foreign(name_job(record.job), record.name);
  }
  return fmt::format("squeue does not list job {}, and scontrol {}", record.job,
                     known.code == 0 ? "knows it" : "reports: " + known.explain());
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
  return fmt::format("{}-{:02}:{:02}:00", minutes / 1440, minutes / 60 % 24, minutes % 60);
}

std::string SlurmDispatcher::find_fault() {
  const ChildOutput version = call({"sbatch", "--version"});
  if (version.code == 0) return "";
  const std::string why = version.explain();
  return why.starts_with("sbatch: ") ? why : "sbatch: " + why;
}

std::string SlurmDispatcher::find_cluster_name() const {
  return slurm::read_settings()["ClusterName"];
}

SiteLimits SlurmDispatcher::check(const Resources& resources, const fs::path& folder) const {
  return slurm::check_site(resources, folder);
}

Findings SlurmDispatcher::examine(const Resources& resources, const fs::path& folder) const {
  return slurm::examine_site(resources, folder);
}

std::vector<NodeInstructionSets> SlurmDispatcher::list_node_instruction_sets(
    const Resources& resources) const {
  const slurm::Partition partition = slurm::find_partition(resources.partition);
  const std::string idle =
      ask({"sinfo", "-h", "-N", "-p", partition.name, "-t", "idle", "-o", "%N"});
  const auto count = std::count(idle.begin(), idle.end(), '\n');
  if (count == 0) return {};
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const std::string output =
      ask({"srun", "--partition=" + partition.name, fmt::format("--nodes={}", count),
           "--ntasks-per-node=1", "--immediate=30", "--quiet", "bash", "-c",
           "echo \"$SLURMD_NODENAME|$(\"$0\" --version)\" | tr '\\n' ' '; echo", program});
  std::vector<NodeInstructionSets> nodes;
  const std::string key = "instruction sets: ";
  for (const std::string& line : split(output, '\n')) {
    const std::size_t bar = line.find('|'), sets = line.find(key);
    if (bar == std::string::npos || sets == std::string::npos) continue;
    nodes.push_back({line.substr(0, bar), line.substr(sets + key.size())});
  }
  return nodes;
}

std::string SlurmDispatcher::make_script(const TaskArray& tasks) const {
  return slurm::make_script(tasks);
}

std::vector<std::string> SlurmDispatcher::make_command(
    const TaskArray& tasks, const fs::path& script, const std::vector<std::string>& after) const {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  for (const std::string& option : slurm::list_options(tasks)) words.push_back(option);
  if (!after.empty()) {
    words.emplace_back("--dependency=afterany");
    for (const std::string& job : after) words.back() += ":" + job;
  }
  words.push_back(script.string());
  return words;
}

std::string SlurmDispatcher::dry_run(const TaskArray& tasks) const {
  std::vector<std::string> words = {"sbatch", "--test-only", "--wrap=:"};
  for (const std::string& option : slurm::list_options(tasks)) words.push_back(option);
  const ChildOutput output = call(words);
  if (output.code == ChildOutput::kNotStarted) return "";
  if (output.code != 0) throw EnvironmentError(fmt::format("sbatch: {}", output.explain()));
  return output.explain();
}

std::string SlurmDispatcher::submit(const TaskArray& tasks, const fs::path& script,
                                    const std::vector<std::string>& after) const {
  const std::vector<std::string> words = make_command(tasks, script, after);
  const std::string answer = ask(words);  // "123" or "123;cluster"
  std::string job = answer.substr(0, answer.find_first_of(";\n"));
  if (parse_number<std::int64_t>(job)) return job;
  throw EnvironmentError(fmt::format(
      "sbatch: printed '{}' instead of the number of a job; `squeue` shows whether the job "
      "is queued",
      answer));
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
      call({"squeue", "-h", "-a", "-r", "--me", "-t", "all", "-o", kQueueFormat});
  if (output.code != 0) return {{}, fmt::format("squeue: {}", output.explain())};
  QueueAnswer answer = parse_queue(output.out, jobs);
  if (!answer.failure.empty()) return answer;
  for (const JobRecord& record : jobs) {
    const bool is_listed = std::any_of(answer.tasks.begin(), answer.tasks.end(),
                                       [&](const QueuedTasks& t) { return t.job == record.job; });
    if (is_listed) continue;
    const std::string doubt = find_doubt(record);
    if (!doubt.empty()) return {{}, doubt};
  }
  return answer;
}

void SlurmDispatcher::cancel(const std::vector<JobRecord>& jobs) const {
  const QueueAnswer answer = query(jobs);
  if (!answer.failure.empty()) {
    throw EnvironmentError(
        fmt::format("{}; nothing is cancelled; use scancel to cancel by hand", answer.failure));
  }
  // Root may cancel the jobs of all users, and a number may have been reused.
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

std::int64_t SlurmDispatcher::find_own_deadline() const {
  // Slurm before 22.05.9 does not set the variable.
  const auto end = parse_number<std::int64_t>(read_environment("SLURM_JOB_END_TIME"));
  if (end) return *end;
  const std::string job = read_environment("SLURM_JOB_ID");
  if (job.empty()) return 0;
  const ChildOutput remaining = call({"squeue", "-h", "-a", "-j", job, "-o", "%L"});
  const auto seconds = parse_slurm_time(remaining.out.substr(0, remaining.out.find('\n')));
  const bool is_known = remaining.code == 0 && seconds && std::isfinite(*seconds);
  return is_known ? std::time(nullptr) + std::lround(*seconds) : 0;
}

int SlurmDispatcher::count_own_restarts() const {
  return parse_number<int>(read_environment("SLURM_RESTART_COUNT")).value_or(0);
}

}  // namespace strut
