// Lists of (name, text): options, facts, settings, and their datasets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/format/hdf5.h"

namespace strut {

/// (name, text) in the order of the file.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// The text of the first entry with this name.
std::optional<std::string> find_text(const NamedTexts& list, const std::string& name);

/// Descriptions of the two datasets of a list.
struct NamedTextsLabel {
  std::string names, texts;
};

/// Writes the datasets GROUP/name and GROUP/value.
void write_named_texts(Hdf5Writer& file, const std::string& group, const NamedTexts& list,
                       const NamedTextsLabel& label);

/// Reads a list from `file`, which messages call `path`. Throws InputError if a dataset is missing
/// or the lengths of the two differ.
NamedTexts read_named_texts(const std::filesystem::path& path, const Hdf5Reader& file,
                            const std::string& group);

}  // namespace strut
