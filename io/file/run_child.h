// Other programs, run without a shell, with the signals of this program's start.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace strut {

/// What a child said.
struct ChildOutput {
  static constexpr int kNotStarted = -1, kTooLong = -2;

  int code = kNotStarted;  // its exit code; 128: a signal ended it; or one of the above
  std::string out, messages;

  /// Its last words in one line, for a message of ours.
  std::string explain() const;
};

struct ChildOptions {
  std::chrono::milliseconds patience = std::chrono::seconds(60);  // then it is ended
  /// Of the environment, what begins so is kept from it.
  std::vector<std::string> hidden_variables{};
  std::string input{};  // what it reads
};

/// Runs words[0], looked for in PATH, in a process group of its own, which Ctrl-C does not reach,
/// and waits for its end.
ChildOutput read_child(const std::vector<std::string>& words, const ChildOptions& options = {});

}  // namespace strut
