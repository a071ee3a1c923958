// The files that a vehicle, rig or maneuver file refers to: a tire, a road profile, an input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace strut {

struct NamedFile {
  std::string key;             // dotted, "tire.file"
  std::filesystem::path path;  // relative to the working directory, or absolute
};

/// Lists every key `file` in its tables. Throws InputError where `file` is missing or not TOML.
std::vector<NamedFile> list_named_files(const std::filesystem::path& file);

}  // namespace strut
