// What kind of file system a folder lies on.
#pragma once

#include <filesystem>
#include <string>

namespace strut {

/// "tmpfs", "ext4", ...: of a file system that other machines do not see; "" where they may: a
/// network's, or one that is not known here. Throws EnvironmentError where it cannot be asked.
std::string find_local_file_system(const std::filesystem::path& folder);

}  // namespace strut
