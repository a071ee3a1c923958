// strut man: the manual page.
#pragma once

#include <string>

#include "jobs/cli/arguments.h"

namespace strut {

Arguments describe_man_page();
int run_man_page(const Arguments& arguments);

/// strut(1) in troff's man macros, of every command's table.
std::string make_man_page();

}  // namespace strut
