// The file or folder that a command writes.
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

/// The folder of --output, made where it is missing. Throws InputError where it is missing, a file,
/// or holds `file`, a `content` of before, and --force is not given; EnvironmentError where it
/// cannot be made.
std::filesystem::path find_output_folder(const Arguments& arguments, const std::string& file,
                                         const std::string& content);

}  // namespace strut
