#include "sweep/named_files.h"

#include "io/toml_text.h"

namespace strut {
namespace {

/// Every key that read_vehicle or read_maneuver reads by Table::file.
constexpr const char* kFileKeys[] = {"tire.file", "bump.file"};

}  // namespace

std::vector<NamedFile> list_named_files(const std::filesystem::path& file) {
  std::vector<NamedFile> files;
  for (const auto& [key, value] : flatten_toml(file)) {
    for (const char* name : kFileKeys) {
      if (key == name) files.push_back({key, file.parent_path() / value});
    }
  }
  return files;
}

}  // namespace strut
