// Standard output: data for people and programs, some of it from files that others wrote.
#pragma once

#include <streambuf>
#include <string>

#include "jobs/cli/terminal.h"

namespace strut {

/// While it lives, std::cout shows control characters as escape_controls() does, whatever a command
/// prints; only print_control() and print_styled() reach the terminal as they are.
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

/// A sequence of the terminal's own.
void print_control(const std::string& sequence);

/// `text` in that style where standard output shows colors.
void print_styled(const std::string& text, Style style);

/// std::printf to std::cout.
[[gnu::format(printf, 1, 2)]] void print_format(const char* format, ...);

}  // namespace strut
