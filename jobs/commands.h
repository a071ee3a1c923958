// The table of the program's commands.
#pragma once

#include <string>

#include "jobs/cli/command.h"

namespace strut {

const CommandTable& list_commands();

/// Throws InputError with the nearest name if there is no such command.
const Command& find_command(const std::string& name);

}  // namespace strut
