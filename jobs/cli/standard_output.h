// Standard output: data for people and programs, parts of it from untrusted files.
#pragma once

#include <streambuf>
#include <string>

#include "jobs/cli/terminal.h"

namespace strut {

/// During its lifetime std::cout escapes control characters, as escape_controls() does, in
/// everything a command prints; only print_control() and print_styled() write them to the terminal.
class StandardOutput {
 public:
  StandardOutput();
  /// Flushes.
  ~StandardOutput();
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

 private:
  std::streambuf* before_;
};

/// Prints a control sequence of the terminal.
void print_control(const std::string& sequence);

/// Prints `text`, in that style if standard output shows colors.
void print_styled(const std::string& text, Style style);

}  // namespace strut
