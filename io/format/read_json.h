// JSON files, read within limits.
#pragma once

#include <filesystem>
#include <string>

#include "base/error/input_error.h"
#include "io/format/json.h"

namespace strut {

/// The text of an exception of the library, without the number that it begins with.
std::string explain(const Json::exception& e);

/// Throws InputError, which names `path`, where a text is nested more than 64 levels deep or not
/// JSON.
Json parse_json(const std::string& text, const std::filesystem::path& path);

/// Reads a regular file, links not followed. Throws InputError where it is missing, a link, larger
/// than 4 MiB, or as parse_json does.
Json read_json(const std::filesystem::path& path);

}  // namespace strut
