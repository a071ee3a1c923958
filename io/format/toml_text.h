// Flattens a TOML file into a list of values, and replaces or sets single values in its text.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error/input_error.h"

namespace strut {

/// Dotted keys and values.
using TomlValues = std::vector<std::pair<std::string, std::string>>;

/// Returns a basic string of TOML that reads back as `text`, which is UTF-8: `"a \\"b\\""`.
std::string quote_toml(const std::string& text);

/// Returns every value of the file ("bump.height", "0.05"), sorted by key: comments, order, blanks
/// and the notation of numbers have no effect. Elements of arrays count from 1, "rod[2].mass".
/// Throws InputError if the file is missing or not TOML.
TomlValues flatten_toml(const std::filesystem::path& path);

/// Returns the file's text with the texts at the dotted keys replaced and all else unchanged.
/// Throws InputError if the file is missing, not TOML, or has no text at one of the keys.
std::string replace_toml_texts(const std::filesystem::path& path, const TomlValues& values);

/// Returns the file's text with the values at the dotted keys set to TOML literals (`"trimmed"`,
/// `-0.2`), including keys that it lacks, and all else unchanged. Throws InputError if the file is
/// missing, not TOML, or its layout does not allow a value to be set.
std::string set_toml_values(const std::filesystem::path& path, const TomlValues& literals);

}  // namespace strut
