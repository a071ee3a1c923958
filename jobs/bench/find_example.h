// The example files that ship with the program.
#pragma once

#include <filesystem>

namespace strut {

/// Path of examples/`name`, looked for in the folders above the working directory and above the
/// program (a build folder within the sources), and in share/strut of an installation. Throws
/// InputError.
std::filesystem::path find_example(const std::filesystem::path& name);

}  // namespace strut
