// Reads whole text files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error/input_error.h"

namespace strut {

/// Reads a whole file. Throws InputError if it is missing or has more than `max_bytes`,
/// EnvironmentError if it cannot be read.
std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes = SIZE_MAX);

}  // namespace strut
