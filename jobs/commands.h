// The table of the program's commands, from which main, help, completion and man page are made.
#pragma once

#include <string>
#include <vector>

#include "jobs/cli/command.h"

namespace strut {

const std::vector<Command>& list_commands();

/// Throws InputError with the nearest name where there is none.
const Command& find_command(const std::string& name);

struct ExitMeaning {
  const char* code;
  const char* meaning;
};

const std::vector<ExitMeaning>& list_exit_meanings();

}  // namespace strut
