// The program as a user meets it: arguments in, exit code, messages and data out.
#pragma once

#include <string>

#include "tests/support/run_shell.h"

namespace strut::test {

inline Outcome run_program(const std::string& arguments) {
  return run_shell(std::string(STRUT_PROGRAM) + " " + arguments);
}

}  // namespace strut::test
