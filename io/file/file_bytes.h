// Reads files as bytes by checked system calls.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "io/file/file_sync.h"

namespace strut {

/// Reads a whole file. Throws InputError if it is missing or not a regular file, EnvironmentError
/// if it cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// The size of an open file, and its bytes from its position on, at most `count`. `path` is for
/// messages. Throw EnvironmentError.
std::size_t read_size(const FileDescriptor& file, const std::filesystem::path& path);
std::vector<std::byte> read_from(const FileDescriptor& file, const std::filesystem::path& path,
                                 std::size_t count);

}  // namespace strut
