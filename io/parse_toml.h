// The parser behind every TOML file; for io only.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>

namespace strut {

/// Throws InputError with file and line where `text`, the content of `path`, is not TOML.
toml::table parse_toml(const std::filesystem::path& path, const std::string& text);

}  // namespace strut
