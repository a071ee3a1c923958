// The next command that every command names at the end of its messages.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/text/quote_word.h"
#include "jobs/commands.h"
#include "tests/support/run_shell.h"

namespace strut::test {

inline std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The words of a line as bash sees them, without a comment at its end.
inline std::vector<std::string> split_as_bash(const std::string& line) {
  const Outcome outcome =
      run_shell("bash -c " + quote_word("eval \"w=($0\n)\"; printf '%s\\n' \"${w[@]}\"") + " " +
                quote_word(line));
  REQUIRE(outcome.code == 0);
  return split_lines(outcome.out);
}

/// The hint at the end of what a command says: its words; and that they can be typed: the command
/// is one, its options are its own.
inline std::vector<std::string> check_hint(const std::string& messages) {
  INFO(messages);
  const std::vector<std::string> lines = split_lines(messages);
  REQUIRE_FALSE(lines.empty());
  REQUIRE(lines.back().starts_with("next: "));
  std::vector<std::string> words = split_as_bash(lines.back().substr(6));
  if (words.front() != "strut") return words;
  REQUIRE(words.size() > 1);
  Arguments arguments = find_command(words[1]).describe();
  const auto redirection = std::find(words.begin(), words.end(), ">");
  CHECK(arguments.parse({words.begin() + 2, redirection}));
  return words;
}

}  // namespace strut::test
