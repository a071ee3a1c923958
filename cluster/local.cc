#include "cluster/local.h"

#include <fcntl.h>
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
  return p.host + "/" + p.boot + "/" + p.name_space + "/" + p.process + "/" + p.start;
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
  return InputError(record.file.string() + ": " + what + "; nothing is stopped" + kRecordRemedy);
}

/// The process of a record. Throws InputError where its text is none of write_identity().
ProcessIdentity parse_record(const JobRecord& record) {
  const std::string letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._:[]";
  ProcessIdentity process = read_identity(record.job);
  const auto number = parse_number<pid_t>(process.process);
  const auto start = parse_number<std::uint64_t>(process.start);
  const bool is_written_so = write_identity(process) == record.job && !process.host.empty() &&
                             record.job.find_first_not_of(letters + "/") == std::string::npos &&
                             number && process.process == std::to_string(*number) && start &&
                             process.start == std::to_string(*start);
  if (!is_written_so) {
    throw record_error(record, "not a job: must be HOST/BOOT/NAMESPACE/PROCESS/START");
  }
  if (*number <= 1 || *number == ::getpid()) {
    throw record_error(record, "process " + process.process + ": never a job's");
  }
  return process;
}

/// Why a process is not the job that a record tells of; "" where it is.
std::string find_doubt(const std::string& process, const JobRecord& record) {
  const auto owner = find_process_owner(process);
  if (!owner) return "it may not be looked at";
  if (owner->user != ::geteuid()) return "it is another user's";
  if (owner->group != process || owner->session != process) return "it leads no session";
  const std::string wanted = std::string(kMark) + "=" + record.mark;
  const auto& variables = owner->environment;
  const bool is_marked = std::find(variables.begin(), variables.end(), wanted) != variables.end();
  return is_marked ? "" : std::string(kMark) + " in its environment is not " + record.mark;
}

/// Whether the job of a record runs, and why a process that does is not proved to be it.
struct JobLife {
  Liveness liveness;
  std::string doubt = {};
};

JobLife judge_job(const JobRecord& record, const ProcessIdentity& process,
                  const ProcessIdentity& own) {
  // What ran before a host was started again has ended.
  if (process.host == own.host && process.boot != own.boot) return {Liveness::kDead};
  Liveness liveness = check_liveness(process, own);
  if (life != Liveness::kAlive) return {life};
  const std::string doubt = find_doubt(process.process, record);
  life = check_liveness(process, own);  // it may have ended while it was looked at
  return {life, life == Liveness::kAlive ? doubt : ""};
}

/// In the child: begins a session, so that it outlives the terminal, tells who it is and becomes
/// the script. `tell` is closed by that: until then nobody may look for the mark.
[[noreturn]] void become(const std::vector<std::string>& command, const std::string& mark,
                         int tell) {
  ::setsid();
  const std::string identity = write_identity(find_own_identity());
  const bool told = ::write(tell, identity.data(), identity.size()) >= 0;
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
  if (told && ::setenv(kMark, mark.c_str(), 1) == 0) ::execvp(words[0], words.data());
  const std::string failure = std::string("\n") + std::strerror(errno);
  (void)!::write(tell, failure.data(), failure.size());
  ::_exit(127);
}

/// Until its other end is closed.
std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 1024> buffer;
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return text;
  }
}

}  // namespace

SiteLimits LocalDispatcher::check(const Resources& resources, const fs::path&) const {
  if (!resources.partition.empty() || !resources.account.empty() || !resources.constraint.empty() ||
      !resources.memory.empty() || resources.seconds > 0.0 || !resources.extra.empty()) {
    throw InputError(
        "--partition, --account, --constraint, --memory, --time, --option: this machine has no "
        "such thing; they go with --to slurm");
  }
  return {};
}

Findings LocalDispatcher::examine(const Resources&, const fs::path&) const {
  return {{"scheduler", Health::kGood, "none: this machine alone",
           "`strut submit --to local` works in the background"}};
}

std::vector<NodeAnswer> LocalDispatcher::ask_nodes(const Resources&) const {
  std::string names;
  for (const char* name : list_instruction_sets()) {
    names += (names.empty() ? "" : " ") + std::string(name);
  }
  return {{find_own_identity().host, names}};
}

std::string LocalDispatcher::make_script(const TaskArray& tasks) const {
  // A zombie, which in a container may stay for ever, has ended, too.
  std::string text = R"(#!/bin/bash
# $1, $2: the process to wait for, if any, and when it was started
set -u
while [[ -n ${1:-} ]] && read -r stat 2>/dev/null </proc/"$1"/stat; do
  fields=(${stat##*) })
  [[ ${fields[0]} != [ZX] && ${fields[19]} == "$2" ]] || break
  sleep 0.2
done
)";
  text += "exec >>" + quote_word((tasks.folder / (tasks.name + ".log")).string()) + " 2>&1\n";
  text += "threads=" + std::to_string(tasks.resources.threads) + "\n";
  text += "for ((task = 0; task < " + std::to_string(tasks.tasks) + "; ++task)); do\n";
  for (const std::string& line : tasks.preparation) text += "  " + line + "\n";
  return text + "  " + tasks.program + "\ndone\n";
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
  std::array<int, 2> ends{-1, -1};
  const pid_t child = ::pipe2(ends.data(), O_CLOEXEC) == 0 ? ::fork() : -1;
  if (child < 0) {
    throw EnvironmentError(script.string() + ": cannot be started: " + std::strerror(errno));
  }
  if (child == 0) {
    // Its parent ends at once, so that init, not this program, waits for it.
    if (::fork() == 0) become(command, tasks.mark, ends[1]);
    ::_exit(0);
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  const std::size_t failure = text.find('\n');
  if (text.empty() || failure != std::string::npos) {
    throw EnvironmentError(script.string() + ": cannot be started" +
                           (text.empty() ? "" : ": bash: " + text.substr(failure + 1)));
  }
  return last_ = text;
}

QueueAnswer LocalDispatcher::query(const std::vector<JobRecord>& jobs) const {
  const ProcessIdentity own = find_own_identity();
  QueueAnswer answer;
  for (const JobRecord& record : jobs) {
    const ProcessIdentity process = parse_record(record);
    const JobLife job = judge_job(record, process, own);
    if (job.life == Liveness::kUnknown) return {{}, "it was submitted on " + process.host};
    if (!job.doubt.empty()) {
      return {{},
              describe_foreign("process " + process.process, record.name) + " (" + job.doubt + ")"};
    }
    if (job.life == Liveness::kAlive) {
      answer.tasks.push_back({record.job, -1, 1, TaskState::kRunning, "RUNNING", ""});
    }
  }
  return answer;
}

void LocalDispatcher::cancel(const std::vector<JobRecord>& jobs) const {
  const ProcessIdentity own = find_own_identity();
  std::vector<pid_t> leaders;  // all are proved before one is stopped
  for (const JobRecord& record : jobs) {
    const ProcessIdentity process = parse_record(record);
    const JobLife job = judge_job(record, process, own);
    if (!job.doubt.empty()) {
      throw record_error(record, describe_foreign("process " + process.process, record.name) +
                                     " (" + job.doubt + ")");
    }
    if (job.life != Liveness::kAlive) continue;
    leaders.push_back(*parse_number<pid_t>(process.process));
  }
  for (const pid_t leader : leaders) {
    if (::kill(-leader, SIGTERM) != 0 && errno != ESRCH) {
      throw EnvironmentError("process " + std::to_string(leader) +
                             ": cannot be stopped: " + std::strerror(errno));
    }
  }
}

}  // namespace strut
