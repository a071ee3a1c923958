// The parser behind every TOML file, and names of values; for io only.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace strut {

/// Reads the whole file. Throws InputError if it is missing or larger than 16 MiB, EnvironmentError
/// if it cannot be read.
std::string read_toml_text(const std::filesystem::path& path);

/// Parses `text`, the content of `path`. Throws InputError with file and line if it is not TOML,
/// nests arrays and tables deeper than 32 levels, or has a dotted key of more than 32 parts, a word
/// of more than 256 bytes or a string of more than 4096.
toml::table parse_toml(const std::filesystem::path& path, const std::string& text);

/// Returns "table.key", or "key" in the root, whose name is "".
std::string join_key(const std::string& table, const std::string& key);
/// Returns "array[1]" for index 0.
std::string name_element(const std::string& array, std::size_t index);

}  // namespace strut
