#include "model_files/named_files.h"

#include "io/format/toml_text.h"

namespace strut {

std::vector<NamedFile> list_named_files(const std::filesystem::path& file) {
  std::vector<NamedFile> files;
  for (const auto& [key, value] : flatten_toml(file)) {
    if (key.ends_with(".file")) files.push_back({key, file.parent_path() / value});
  }
  return files;
}

}  // namespace strut
