// A TOML file as a list of values, and with single values replaced or set.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"

namespace strut {

/// Dotted key and value.
using TomlValues = std::vector<std::pair<std::string, std::string>>;

/// A basic string of TOML that reads back as `text`, which is UTF-8: `"a \\"b\\""`.
std::string quote_toml(const std::string& text);

/// Every value of the file as it was meant ("bump.height", "0.05"), sorted by key: comments, order,
/// blanks and the way a number is written have no effect. Elements of arrays count from 1,
/// "rod[2].mass". Throws InputError where the file is missing or not TOML.
TomlValues flatten_toml(const std::filesystem::path& path);

/// The file's text with the texts at the dotted keys replaced, everything else as it stands. Throws
/// InputError where the file is missing, not TOML, or has no text there.
std::string replace_toml_texts(const std::filesystem::path& path, const TomlValues& values);

/// The file's text with the values at the dotted keys set to TOML literals (`"trimmed"`, `-0.2`),
/// also where there were none; everything else as it stands. Throws InputError where the file is
/// missing, not TOML, or is written such that a value has no place to be set at.
std::string set_toml_values(const std::filesystem::path& path, const TomlValues& literals);

}  // namespace strut
