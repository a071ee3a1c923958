#include "io/parse_toml.h"

#include "io/input_error.h"

namespace strut {

toml::table parse_toml(const std::filesystem::path& path, const std::string& text) {
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& e) {
    throw InputError(path.string() + ":" + std::to_string(e.source().begin.line) +
                     ": not valid TOML: " + std::string(e.description()));
  }
}

}  // namespace strut
