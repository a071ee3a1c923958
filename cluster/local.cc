#include "cluster/local.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>

#include "base/error/input_error.h"
#include "base/parallel/instruction_sets.h"
#include "base/text/parse_number.h"
#include "base/text/quote_word.h"
#include "cluster/record_file.h"
#include "io/file/process_identity.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "STRUT_JOB";

std::string write_identity(const ProcessIdentity& p) {
  return fmt::format("{}/{}/{}/{}/{}", p.host, p.boot, p.name_space, p.process, p.start);
}

ProcessIdentity read_identity(const std::string& text) {
  std::istringstream stream(text);
  ProcessIdentity p;
  for (std::string* part : {&p.host, &p.boot, &p.name_space, &p.process, &p.start}) {
    std::getline(stream, *part, '/');
  }
  return p;
}

InputError record_error(const JobRecord& record, const std::string& what) {
  return InputError(
      fmt::format("{}: {}; nothing is stopped; {}", record.file.string(), what, kRecordRemedy));
}

/// Returns the process of a record. Throws InputError if write_identity() cannot have written it.
ProcessIdentity parse_record(const JobRecord& record) {
  const std::string letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._:[]";
  ProcessIdentity process = read_identity(record.job);
  const auto number = parse_number<pid_t>(process.process);
  const auto start = parse_number<std::uint64_t>(process.start);
  const bool is_valid = write_identity(process) == record.job && !process.host.empty() &&
                        record.job.find_first_not_of(letters + "/") == std::string::npos &&
                        number && process.process == std::to_string(*number) && start &&
                        process.start == std::to_string(*start);
  if (!is_valid) {
    throw record_error(record, "not a job: must be HOST/BOOT/NAMESPACE/PROCESS/START");
  }
  if (*number <= 1 || *number == ::getpid()) {
    throw record_error(record, fmt::format("process {}: cannot be a job", process.process));
  }
  return process;
}

/// Returns why a process is not the job of a record; "" if it is.
std::string find_doubt(const std::string& process, const JobRecord& record) {
  const auto owner = find_process_owner(process);
  if (!owner) return "its owner cannot be determined";
  if (owner->user != ::geteuid()) return "it belongs to another user";
  if (owner->group != process || owner->session != process) return "it does not lead a session";
  const std::string wanted = fmt::format("{}={}", kMark, record.mark);
  const auto& variables = owner->environment;
  const bool is_marked = std::find(variables.begin(), variables.end(), wanted) != variables.end();
  return is_marked ? "" : fmt::format("{} in its environment is not {}", kMark, record.mark);
}

/// Liveness of the job of a record, and why a running process is not proved to be that job.
struct JobLiveness {
  Liveness liveness;
  std::string doubt = {};
};

JobLiveness judge_job(const JobRecord& record, const ProcessIdentity& process,
                      const ProcessIdentity& own) {
  // All processes ended when the host was booted again.
  if (process.host == own.host && process.boot != own.boot) return {Liveness::kDead};
  Liveness liveness = check_liveness(process, own);
  if (liveness != Liveness::kAlive) return {liveness};
  const std::string doubt = find_doubt(process.process, record);
  liveness = check_liveness(process, own);  // it may have ended meanwhile
  return {liveness, liveness == Liveness::kAlive ? doubt : ""};
}

std::string describe_doubt(const JobRecord& record, const ProcessIdentity& process,
                           const std::string& doubt) {
  const std::string job = fmt::format("process {}", process.process);
  return fmt::format("{} ({})", describe_foreign(job, record.name), doubt);
}

/// Runs in the child: starts a session, so that it outlives the terminal, writes its identity to
/// `report` and executes the script, which closes `report`: until then the mark is not in place.
[[noreturn]] void execute(const std::vector<std::string>& command, const std::string& mark,
                          int report) {
  ::setsid();
  const std::string identity = write_identity(find_own_identity());
  const bool reported = ::write(report, identity.data(), identity.size()) >= 0;
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(nothing, descriptor);
  }
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  if (reported && ::setenv(kMark, mark.c_str(), 1) == 0) ::execvp(words[0], words.data());
  const std::string failure = std::string("\n") + std::strerror(errno);
  (void)!::write(report, failure.data(), failure.size());
  ::_exit(127);
}

/// Reads until the other end is closed.
std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 1024> buffer;
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

/// Starts a command in a session of its own, whose identity it returns. Throws EnvironmentError
/// that names `script`.
std::string start_session(const std::vector<std::string>& command, const std::string& mark,
                          const fs::path& script) {
  constexpr char kNotStarted[] = "cannot be started";
  std::array<int, 2> ends{-1, -1};
  const pid_t child = ::pipe2(ends.data(), O_CLOEXEC) == 0 ? ::fork() : -1;
  if (child < 0) throw file_failure(script, kNotStarted, errno);
  if (child == 0) {
    // Its parent ends at once, so that init, not this program, waits for it.
    if (::fork() == 0) execute(command, mark, ends[1]);
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text = read_all(ends[0]);
  ::close(ends[0]);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  const std::size_t failure = text.find('\n');
  if (!text.empty() && failure == std::string::npos) return text;
  const std::string cause = text.empty() ? "" : ": bash: " + text.substr(failure + 1);
  throw EnvironmentError(fmt::format("{}: {}{}", script.string(), kNotStarted, cause));
}

}  // namespace

SiteLimits LocalDispatcher::check(const Resources& resources, const fs::path&) const {
  if (!resources.partition.empty() || !resources.account.empty() || !resources.constraint.empty() ||
      !resources.memory.empty() || resources.seconds > 0.0 || !resources.extra.empty()) {
    throw InputError(
        "--partition, --account, --constraint, --memory, --time, --option: not available on this "
        "machine; they require --to slurm");
  }
  return {};
}

Findings LocalDispatcher::examine(const Resources&, const fs::path&) const {
  return {{"scheduler", Health::kGood, "none: this machine only",
           "`strut submit --to local` runs in the background"}};
}

std::vector<NodeInstructionSets> LocalDispatcher::list_node_instruction_sets(
    const Resources&) const {
  return {{find_own_identity().host, fmt::format("{}", fmt::join(list_instruction_sets(), " "))}};
}

std::string LocalDispatcher::make_script(const TaskArray& tasks) const {
  // A zombie, which in a container may stay forever, has ended as well.
  std::string text = R"(#!/bin/bash
# $1, $2: the process to wait for, if any, and when it was started
set -u
while [[ -n ${1:-} ]] && read -r stat 2>/dev/null </proc/"$1"/stat; do
  fields=(${stat##*) })
  [[ ${fields[0]} != [ZX] && ${fields[19]} == "$2" ]] || break
  sleep 0.2
done
)";
  const std::string log = (tasks.folder / (tasks.name + ".log")).string();
  text += fmt::format("exec >>{} 2>&1\n", quote_word(log));
  text += fmt::format("threads={}\n", tasks.resources.threads);
  text += fmt::format("for ((task = 0; task < {}; ++task)); do\n", tasks.tasks);
  for (const std::string& line : tasks.preparation) text += fmt::format("  {}\n", line);
  return text + fmt::format("  {}\ndone\n", tasks.program);
}

std::vector<std::string> LocalDispatcher::make_command(const TaskArray&, const fs::path& script,
                                                       const std::vector<std::string>&) const {
  return {"bash", script.string()};
}

std::string LocalDispatcher::submit(const TaskArray& tasks, const fs::path& script,
                                    const std::vector<std::string>& after) const {
  std::vector<std::string> command = make_command(tasks, script, after);
  const std::string wait_for = last_.empty() ? (after.empty() ? "" : after.back()) : last_;
  if (!wait_for.empty()) {
    const ProcessIdentity process = read_identity(wait_for);
    command.insert(command.end(), {process.process, process.start});
  }
  return last_ = start_session(command, tasks.mark, script);
}

QueueAnswer LocalDispatcher::query(const std::vector<JobRecord>& jobs) const {
  const ProcessIdentity own = find_own_identity();
  QueueAnswer answer;
  for (const JobRecord& record : jobs) {
    const ProcessIdentity process = parse_record(record);
    const JobLiveness job = judge_job(record, process, own);
    if (job.liveness == Liveness::kUnknown)
      return {{}, fmt::format("it was submitted on {}", process.host)};
    if (!job.doubt.empty()) return {{}, describe_doubt(record, process, job.doubt)};
    if (job.liveness == Liveness::kAlive) {
      answer.tasks.push_back({record.job, -1, 1, TaskState::kRunning, "RUNNING", ""});
    }
  }
  return answer;
}

void LocalDispatcher::cancel(const std::vector<JobRecord>& jobs) const {
  const ProcessIdentity own = find_own_identity();
  std::vector<pid_t> leaders;  // all are proved before any is stopped
  for (const JobRecord& record : jobs) {
    const ProcessIdentity process = parse_record(record);
    const JobLiveness job = judge_job(record, process, own);
    if (!job.doubt.empty()) throw record_error(record, describe_doubt(record, process, job.doubt));
    if (job.liveness != Liveness::kAlive) continue;
    leaders.push_back(*parse_number<pid_t>(process.process));
  }
  for (const pid_t leader : leaders) {
    if (::kill(-leader, SIGTERM) != 0 && errno != ESRCH) {
      throw file_failure(fmt::format("process {}", leader), "cannot be stopped", errno);
    }
  }
}

}  // namespace strut
