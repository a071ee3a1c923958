// A command of the program, and the exit codes that all commands share.
#pragma once

#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// Exit codes of the program; 128 + the number of the signal if one ended it.
enum ExitCode : int {
  kExitDone = 0,
  kExitNegative = 1,     // completed; the result is negative
  kExitInput = 2,        // the user's input is invalid
  kExitEnvironment = 3,  // disk full, file unreadable, ...
  kExitBug = 70,         // an invariant of the program is broken (EX_SOFTWARE of sysexits.h)
};

/// A row of the table of exit codes in help and manual page.
struct ExitMeaning {
  const char* code;
  const char* meaning;
};

const std::vector<ExitMeaning>& list_exit_meanings();

struct Command {
  const char* name;
  const char* purpose;  // one line
  /// Makes the table of its arguments, from which --help, completion and manual page are generated.
  Arguments (*describe)();
  /// Runs the command on parsed arguments and returns an exit code. Throws InputError,
  /// EnvironmentError.
  int (*run)(const Arguments& arguments);
};

using CommandTable = std::vector<Command>;

}  // namespace strut
