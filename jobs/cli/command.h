// What a command of the program is, and the exit codes all of them share.
#pragma once

#include "jobs/cli/arguments.h"

namespace strut {

/// What the program's caller learns from its exit code; 128 + the signal where one stopped it.
enum ExitCode : int {
  kExitDone = 0,
  kExitNegative = 1,     // it ran, and the answer is no
  kExitInput = 2,        // the user's input is wrong
  kExitEnvironment = 3,  // disk full, file unreadable, ...
  kExitBug = 70,         // an invariant of the program is broken (EX_SOFTWARE of sysexits.h)
};

struct Command {
  const char* name;
  const char* purpose;  // one line
  /// The table of its arguments: what --help, completion and man page are made of.
  Arguments (*describe)();
  /// Takes them parsed, returns an exit code. Throws InputError, EnvironmentError.
  int (*run)(const Arguments& arguments);
};

}  // namespace strut
