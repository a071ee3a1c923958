// A command as a user meets it: exit code, messages and data out.
#pragma once

#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "tests/support/temporary_folder.h"

namespace strut::test {

struct Outcome {
  int code = -1;  // -1: ended by a signal
  std::string out, messages;
};

inline Outcome run_shell(const std::string& command) {
  const TemporaryFolder folder;
  const std::string messages = folder / "messages";
  FILE* pipe = ::popen((command + " 2>" + messages).c_str(), "r");
  REQUIRE(pipe != nullptr);
  Outcome outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.out.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  outcome.messages = read_text(messages);
  return outcome;
}

}  // namespace strut::test
