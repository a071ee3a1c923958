// The example files that ship with the program.
#pragma once

#include <filesystem>

namespace strut {

/// Path of examples/`name`, looked for in the folders above the program (a build folder within the
/// sources), in share/strut of its installation, wherever that was moved, and at last above the
/// working directory. Throws InputError.
std::filesystem::path find_example(const std::filesystem::path& name);

}  // namespace strut
