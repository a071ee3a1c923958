#include "jobs/dispatch/local.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>

#include "io/input_error.h"
#include "io/parse_number.h"
#include "io/process_identity.h"
#include "jobs/dispatch/quote_word.h"
#include "model/kernel/simulation.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

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

/// In the child: begins a session, so that it outlives the terminal, tells who it is and becomes
/// the script.
[[noreturn]] void become(const fs::path& script, const ProcessIdentity& wait_for, int tell) {
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
  if (told) {
    ::execlp("bash", "bash", script.c_str(), wait_for.process.c_str(), wait_for.start.c_str(),
             nullptr);
  }
  ::_exit(127);
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
  for (const Kernel& kernel : list_kernels()) {
    names += (names.empty() ? "" : " ") + std::string(kernel.isa);
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

std::string LocalDispatcher::submit(const fs::path& script,
                                    const std::vector<std::string>& after) const {
  const std::string wait_for = last_.empty() ? (after.empty() ? "" : after.back()) : last_;
  std::array<int, 2> ends{-1, -1};
  const pid_t child = ::pipe2(ends.data(), O_CLOEXEC) == 0 ? ::fork() : -1;
  if (child < 0) {
    throw EnvironmentError(script.string() + ": cannot be started: " + std::strerror(errno));
  }
  if (child == 0) {
    // Its parent ends at once, so that init, not this program, waits for it.
    if (::fork() == 0) become(script, read_identity(wait_for), ends[1]);
    ::_exit(0);
  }
  ::close(ends[1]);
  std::array<char, 1024> text{};
  const ssize_t count = ::read(ends[0], text.data(), text.size());
  ::close(ends[0]);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
  if (count <= 0) throw EnvironmentError(script.string() + ": cannot be started");
  last_.assign(text.data(), static_cast<std::size_t>(count));
  return last_;
}

QueueAnswer LocalDispatcher::query(const std::map<std::string, std::string>& names) const {
  const ProcessIdentity own = find_own_identity();
  QueueAnswer answer;
  for (const auto& [job, name] : names) {  // such a job's number is never another's
    const ProcessIdentity process = read_identity(job);
    // What ran before a host was started again has ended.
    if (process.host == own.host && process.boot != own.boot) continue;
    const Life life = judge_process(process, own);
    if (life == Life::kUnknown) return {{}, "it was submitted on " + process.host};
    if (life == Life::kRuns) {
      answer.tasks.push_back({job, -1, 1, TaskState::kRunning, "RUNNING", ""});
    }
  }
  return answer;
}

void LocalDispatcher::cancel(const std::map<std::string, std::string>& names) const {
  const ProcessIdentity own = find_own_identity();
  for (const auto& [job, name] : names) {
    const ProcessIdentity process = read_identity(job);
    const auto number = parse_number<pid_t>(process.process);
    if (!number || judge_process(process, own) != Life::kRuns) continue;
    if (::kill(-*number, SIGTERM) != 0 && errno != ESRCH) {
      throw EnvironmentError("process " + process.process +
                             ": cannot be stopped: " + std::strerror(errno));
    }
  }
}

}  // namespace strut
