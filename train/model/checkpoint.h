// A training halfway as a file, to go on from.
#pragma once

#include <filesystem>
#include <vector>

#include "io/format/named_texts.h"
#include "train/network/growing_sample.h"

namespace strut {

/// A training between two epochs.
struct Checkpoint {
  /// Everything that decides how it goes on.
  NamedTexts started_with;
  GrowingSampleState state;
  std::vector<EpochRecord> record;
};

/// Appears whole or not at all; replaces a file of that name. Throws EnvironmentError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Throws InputError that names the file and what is wrong.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// Throws InputError with a line for each fact that is another in `now`.
void require_same_start(const std::filesystem::path& path, const Checkpoint& checkpoint,
                        const NamedTexts& now);

}  // namespace strut
