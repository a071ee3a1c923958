// Reads JSON files within limits of size and nesting.
#pragma once

#include <filesystem>
#include <string>

#include "base/error/input_error.h"
#include "io/format/json.h"

namespace strut {

/// Returns the text of an exception of the library without the number at its beginning.
std::string explain(const Json::exception& e);

/// Parses the content of `path`. Throws InputError that names `path` if the text is not JSON or is
/// nested more than 64 levels deep.
Json parse_json(const std::string& text, const std::filesystem::path& path);

/// Reads a regular file without following links. Throws InputError if it is missing, a link or
/// larger than 4 MiB, or as parse_json does.
Json read_json(const std::filesystem::path& path);

}  // namespace strut
