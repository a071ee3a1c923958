// Lists of (name, text): options, facts, settings, and how they lie in a file.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/format/hdf5.h"

namespace strut {

/// (name, text) in the order of the file.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

/// What the two datasets of a list mean.
struct NamedTextsLabel {
  std::string names, texts;
};

/// Datasets GROUP/name and GROUP/value.
void write_named_texts(Hdf5Writer& file, const std::string& group, const NamedTexts& list,
                       const NamedTextsLabel& label);

/// `path` stands in messages. Throws InputError where a dataset is missing or the two are not of
/// one length.
NamedTexts read_named_texts(const std::filesystem::path& path, const Hdf5Reader& file,
                            const std::string& group);

}  // namespace strut
