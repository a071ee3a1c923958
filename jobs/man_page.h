// strut man: the manual page.
#pragma once

#include <string>

#include "jobs/cli/command.h"

namespace strut {

Arguments describe_man_page();
int run_man_page(const Arguments& arguments, const CommandTable& commands);

/// Returns strut(1) in troff's man macros, generated from the commands' tables of arguments.
std::string make_man_page(const CommandTable& commands);

}  // namespace strut
