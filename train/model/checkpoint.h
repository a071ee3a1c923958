// Checkpoint files, from which a training resumes.
#pragma once

#include <filesystem>
#include <vector>

#include "io/format/named_texts.h"
#include "train/network/growing_sample.h"

namespace strut {

/// State of a training between two epochs.
struct Checkpoint {
  /// Everything that determines how the training continues.
  NamedTexts started_with;
  GrowingSampleState state;
  std::vector<EpochRecord> record;
};

/// Writes atomically; replaces an existing file. Throws EnvironmentError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Throws InputError, which names the file and the fault.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// Throws InputError, with one line for each fact that differs, unless `now` equals the start of
/// the checkpoint.
void require_same_start(const std::filesystem::path& path, const Checkpoint& checkpoint,
                        const NamedTexts& now);

}  // namespace strut
