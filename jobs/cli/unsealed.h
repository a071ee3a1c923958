// Notes about files that an earlier version of strut wrote without a seal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/file_seal.h"
#include "train/model/model_file.h"

namespace strut {

/// Prints a note, once for each file, if `file` has no seal, and how to get a sealed one.
void note_unsealed(const std::filesystem::path& file, const SealKind& kind);
/// The same for `paths` of sweep folders (their plans) and merged files.
void note_unsealed_data(const std::vector<std::string>& paths);
/// Reads a trained model and calls note_unsealed().
TrainedModel load_model(const std::filesystem::path& file);

}  // namespace strut
