#include "io/file/run_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <span>

#include "io/file/file_sync.h"

namespace strut {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// File actions of posix_spawn, for the child's descriptors.
class FileActions {
 public:
  FileActions() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  /// Makes `open` available to the child as `descriptor`.
  void set(int descriptor, int open) {
    posix_spawn_file_actions_adddup2(&actions_, open, descriptor);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

std::vector<char*> list_environment(const std::vector<std::string>& hidden) {
  std::vector<char*> kept;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const bool is_hidden =
        std::any_of(hidden.begin(), hidden.end(),
                    [&](const std::string& prefix) { return text.starts_with(prefix); });
    if (!is_hidden) kept.push_back(*variable);
  }
  kept.push_back(nullptr);
  return kept;
}

/// Returns the process number; -1 if the child cannot be started.
pid_t start(const std::vector<std::string>& words, const FileActions& actions,
            const std::vector<char*>& environment) {
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes,
                           static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, pointers[0], actions.get(), &attributes, pointers.data(),
                                   environment.data());
  posix_spawnattr_destroy(&attributes);
  return failure == 0 ? child : -1;
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

/// A pipe; a child gets the writing end.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) == 0) {
      from = ends[0];
      to = ends[1];
    }
  }
  ~Pipe() {
    close_end(from);
    close_end(to);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }

  int from = -1, to = -1;
};

/// Appends the bytes that are available; closes the pipe at its end.
void read_available(Pipe& pipe, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(pipe.from, buffer.data(), buffer.size());
  if (count > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
  } else if (count == 0 || errno != EINTR) {
    Pipe::close_end(pipe.from);
  }
}

/// Reads until both pipes are closed; false if that takes longer than `timeout`.
bool read_all(Pipe& out, Pipe& messages, ChildOutput& output, std::chrono::milliseconds timeout) {
  const auto end = SteadyClock::now() + timeout;
  while (out.from >= 0 || messages.from >= 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - SteadyClock::now());
    if (left.count() <= 0) return false;
    std::array<pollfd, 2> wanted = {pollfd{out.from, POLLIN, 0}, pollfd{messages.from, POLLIN, 0}};
    if (::poll(wanted.data(), wanted.size(), static_cast<int>(left.count())) <= 0) continue;
    if (wanted[0].revents != 0) read_available(out, output.out);
    if (wanted[1].revents != 0) read_available(messages, output.messages);
  }
  return true;
}

}  // namespace

std::string ChildOutput::explain() const {
  if (code == kNotStarted) return "it cannot be started";
  const std::string& text = messages.empty() ? out : messages;
  const std::size_t last = text.find_last_not_of(" \n");
  if (last == std::string::npos) {
    return code == kTimedOut ? "it did not answer in time"
                             : fmt::format("it ended with code {} and printed nothing", code);
  }
  const std::size_t before = text.rfind('\n', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return text.substr(first, last + 1 - first);
}

ChildOutput read_child(const std::vector<std::string>& words, const ChildOptions& options) {
  ChildOutput output;
  Pipe out, messages;
  FileActions actions;
  actions.set(STDOUT_FILENO, out.to);
  actions.set(STDERR_FILENO, messages.to);
  const FileDescriptor input(::memfd_create("input", MFD_CLOEXEC));
  if (!options.input.empty()) {
    write_all(input.get(), std::as_bytes(std::span(options.input)), words.front());
    ::lseek(input.get(), 0, SEEK_SET);
    actions.set(STDIN_FILENO, input.get());
  }
  const pid_t child = start(words, actions, list_environment(options.hidden_variables));
  if (child < 0) return output;
  Pipe::close_end(out.to);
  Pipe::close_end(messages.to);
  const bool in_time = read_all(out, messages, output, options.timeout);
  if (!in_time) ::kill(child, SIGKILL);
  const int code = wait_for(child);
  output.code = in_time ? code : ChildOutput::kTimedOut;
  return output;
}

}  // namespace strut
