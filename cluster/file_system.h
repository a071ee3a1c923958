// Detects file systems that only one machine sees.
#pragma once

#include <filesystem>
#include <string>

namespace strut {

/// Returns the kind ("tmpfs", "ext4", ...) of the folder's file system if other machines cannot see
/// it; "" if they may: a network file system or an unknown one. Throws EnvironmentError.
std::string find_local_file_system(const std::filesystem::path& folder);

}  // namespace strut
