// Runs other programs without a shell and with no signals blocked.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace strut {

/// Output and exit code of a child process.
struct ChildOutput {
  static constexpr int kNotStarted = -1, kTimedOut = -2;

  int code = kNotStarted;     // exit code; 128: ended by a signal; or one of the above
  std::string out, messages;  // standard output, standard error

  /// Summarizes the failure for a message: the last line of the output, else the exit code.
  std::string explain() const;
};

struct ChildOptions {
  std::chrono::milliseconds timeout = std::chrono::seconds(60);  // the child is killed after it
  /// Prefixes of the environment variables ("NAME=VALUE") that the child does not get.
  std::vector<std::string> hidden_variables{};
  std::string input{};  // its standard input
};

/// Runs words[0], found through PATH, in its own process group, which Ctrl-C does not reach, and
/// waits for it to end.
ChildOutput read_child(const std::vector<std::string>& words, const ChildOptions& options = {});

}  // namespace strut
