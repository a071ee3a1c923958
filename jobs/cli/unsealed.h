// Files that an earlier version wrote without a seal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/file_seal.h"
#include "train/model/model_file.h"

namespace strut {

/// Notes, once for each file, that `file` has no seal and how to get one that has.
void note_unsealed(const std::filesystem::path& file, const SealKind& kind);
/// The same of the plans of sweep folders and of merged files among the data of a command.
void note_unsealed_data(const std::vector<std::string>& paths);
/// read_model, and the note.
TrainedModel load_model(const std::filesystem::path& file);

}  // namespace strut
