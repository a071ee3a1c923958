// A whole file as bytes, by plain checked system calls.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace strut {

/// Throws InputError where the file is missing or not a regular one, EnvironmentError where it
/// cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// The first `count` bytes, fewer where the file is shorter. Throws as read_bytes.
std::vector<std::byte> read_first_bytes(const std::filesystem::path& path, std::size_t count);

}  // namespace strut
