// Other programs, run without a shell, with the signals of this program's start.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace strut {

/// Where a child's output goes.
struct ChildFiles {
  std::filesystem::path output, messages;
};

/// Runs words[0], looked for in PATH, with nothing to read, and waits. Returns its exit code; 128
/// where a signal ended it; -1 where it cannot be started.
int run_child(const std::vector<std::string>& words, const ChildFiles& files);

/// What a child said.
struct ChildOutput {
  static constexpr int kNotStarted = -1, kTooLong = -2;

  int code = kNotStarted;  // as run_child, or one of the above
  std::string out, messages;

  /// Its last words in one line, for a message of ours.
  std::string explain() const;
};

struct ChildOptions {
  std::chrono::milliseconds patience = std::chrono::seconds(60);  // then it is ended
  /// Of the environment, what begins so is kept from it.
  std::vector<std::string> hidden_variables{};
};

/// The same, with its output, and in a process group of its own: Ctrl-C does not reach it.
ChildOutput read_child(const std::vector<std::string>& words, const ChildOptions& options = {});

}  // namespace strut
