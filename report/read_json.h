// JSON files, read within limits: the parser recurses once per level.
#pragma once

#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <string>

namespace strut {

using JsonTree = boost::property_tree::ptree;

/// Throws InputError, which names `path`, where a text is nested more than 64 levels deep or not
/// JSON.
JsonTree parse_json(const std::string& text, const std::filesystem::path& path);

/// Reads a regular file, links not followed. Throws InputError where it is missing, a link, larger
/// than 256 MiB, or as parse_json does.
JsonTree read_json(const std::filesystem::path& path);

}  // namespace strut
