// Finds the example files that are distributed with the program.
#pragma once

#include <filesystem>

namespace strut {

/// Returns the path of examples/`name`: in a folder above the program (a build folder in the
/// sources), in share/strut of its installation, even if that was moved, or else in a folder above
/// the working directory. Throws InputError.
std::filesystem::path find_example(const std::filesystem::path& name);

}  // namespace strut
