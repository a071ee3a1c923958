// The files that a vehicle, rig or maneuver file names in turn: a tire, a road profile, an input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace strut {

struct NamedFile {
  std::string key;             // dotted, "tire.file"
  std::filesystem::path path;  // where it is
};

/// Every key `file` in a table of it. Throws InputError where `file` is missing or not TOML.
std::vector<NamedFile> list_named_files(const std::filesystem::path& file);

}  // namespace strut
