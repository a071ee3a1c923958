// A whole file as bytes, by plain checked system calls.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace strut {

/// Replaces the content of an existing file. Throws EnvironmentError that names `shown` (of a
/// temporary file: the name that the user knows).
void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes,
                 const std::filesystem::path& shown);

/// Throws InputError where the file is missing or cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// The first `count` bytes, fewer where the file is shorter. Throws InputError.
std::vector<std::byte> read_first_bytes(const std::filesystem::path& path, std::size_t count);

}  // namespace strut
