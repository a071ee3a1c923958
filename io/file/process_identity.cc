#include "io/file/process_identity.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <sstream>

#include "base/text/parse_number.h"
#include "io/file/file_sync.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

std::string read_word(const fs::path& path) {
  std::istringstream text(read_if_present(path).value_or(""));
  std::string word;
  text >> word;
  return word;
}

struct ProcessState {
  char letter = '?';
  std::string group, session;
  std::string start;  // clock ticks since boot
};

std::string read_process_file(const std::string& process, const std::string& name) {
  try {
    return read_if_present("/proc/" + process + "/" + name).value_or("");
  } catch (const EnvironmentError&) {  // it ended meanwhile, or belongs to another user
    return "";
  }
}

// Reads fields 3 to 6 and 22 of proc(5): "PID (NAME) STATE PPID PGRP SESSION ... STARTTIME",
// counted from the end of the name, which may contain anything. The start is empty if unknown.
ProcessState read_process_state(const std::string& process) {
  const std::string text = read_process_file(process, "stat");
  const auto name_end = text.rfind(')');
  ProcessState state;
  if (name_end == std::string::npos) return state;
  std::istringstream fields(text.substr(name_end + 1));
  constexpr int kFieldsBetween = 15;
  std::string between;
  fields >> state.letter >> between >> state.group >> state.session;
  for (int i = 0; i < kFieldsBetween; ++i) fields >> between;
  fields >> state.start;
  return state;
}

// Host name with every character that a file name or a line may not contain replaced.
std::string get_host_name() {
  std::array<char, 65> buffer{};
  ::gethostname(buffer.data(), buffer.size() - 1);
  std::string name(buffer.data());
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-' && c != '.') c = '_';
  }
  return name.empty() ? "localhost" : name;
}

bool share_process_numbers(const ProcessIdentity& a, const ProcessIdentity& b) {
  return !a.boot.empty() && !a.name_space.empty() && a.host == b.host && a.boot == b.boot &&
         a.name_space == b.name_space;
}

}  // namespace

ProcessIdentity find_own_identity() {
  ProcessIdentity own;
  own.host = get_host_name();
  own.boot = read_word("/proc/sys/kernel/random/boot_id");
  std::error_code ignored;
  own.name_space = fs::read_symlink("/proc/self/ns/pid", ignored).string();
  own.process = std::to_string(::getpid());
  own.start = read_process_state("self").start;
  return own;
}

bool is_process_number_taken(const std::string& process) {
  const pid_t number = parse_number<pid_t>(process).value_or(0);
  return number > 0 && (::kill(number, 0) == 0 || errno != ESRCH);
}

Liveness check_liveness(const ProcessIdentity& process, const ProcessIdentity& own) {
  if (!share_process_numbers(process, own)) return Liveness::kUnknown;
  const pid_t number = parse_number<pid_t>(process.process).value_or(0);
  if (number <= 0) return Liveness::kUnknown;
  if (!is_process_number_taken(process.process)) return Liveness::kDead;
  const ProcessState state = read_process_state(process.process);
  // /proc may hide the processes of other users; a runner's file may be incomplete.
  if (state.start.empty() || process.start.empty()) return Liveness::kUnknown;
  // A zombie has ended, though in a container its parent may never collect its exit status.
  const bool ended = state.letter == 'Z' || state.letter == 'X';
  return ended || state.start != process.start ? Liveness::kDead : Liveness::kAlive;
}

std::optional<ProcessOwner> find_process_owner(const std::string& process) {
  struct stat status {};
  if (::stat(("/proc/" + process).c_str(), &status) != 0) return std::nullopt;
  const ProcessState state = read_process_state(process);
  if (state.start.empty()) return std::nullopt;
  ProcessOwner owner{status.st_uid, state.group, state.session, {}};
  std::istringstream environment(read_process_file(process, "environ"));
  for (std::string variable; std::getline(environment, variable, '\0');) {
    owner.environment.push_back(variable);
  }
  return owner;
}

}  // namespace strut
