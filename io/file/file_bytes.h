// Reads files as bytes by checked system calls.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace strut {

/// Reads a whole file. Throws InputError if it is missing or not a regular file, EnvironmentError
/// if it cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// Reads the first `count` bytes, or the whole file if it is shorter. Throws as read_bytes.
std::vector<std::byte> read_first_bytes(const std::filesystem::path& path, std::size_t count);

}  // namespace strut
