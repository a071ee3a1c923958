// The parser behind every TOML file; for io only.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>

namespace strut {

/// The whole file. Throws InputError where it is missing or larger than 16 MiB, EnvironmentError
/// where it cannot be read.
std::string read_toml_text(const std::filesystem::path& path);

/// Throws InputError with file and line where `text`, the content of `path`, is not TOML, nests
/// arrays and tables deeper than 32 levels, or has a dotted key of more than 32 parts, a word of
/// more than 256 bytes or a string of more than 4096.
toml::table parse_toml(const std::filesystem::path& path, const std::string& text);

}  // namespace strut
