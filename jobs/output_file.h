// The file that a command writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/arguments.h"

namespace strut {

/// The value of --output, which --force lets replace a file. Throws InputError where it is missing,
/// a folder, a file that is there (without --force), or one of `inputs`, what the command reads;
/// EnvironmentError where its folder is not there.
std::filesystem::path find_output_file(const Arguments& arguments,
                                       const std::vector<std::string>& inputs);

}  // namespace strut
