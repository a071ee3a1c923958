// Making and opening a sweep folder.
#pragma once

#include <filesystem>

#include "io/store/sweep_folder.h"
#include "sweep/plan.h"

namespace strut {

/// Makes the subfolders that are not there: a copy may have lost the empty ones. Throws
/// EnvironmentError.
void make_subfolders(const SweepFolder& folder);

/// Makes the folder of a plan: request.toml with copies of every file it names, plan.h5, the empty
/// subfolders; plan.h5 last, so a folder is planned or it is not. Planning the same request again
/// changes nothing, but seals a plan.h5 of an earlier version. Throws InputError where `root` holds
/// another plan (it lists what changed) or is no folder of ours, EnvironmentError where it cannot
/// be written.
SweepFolder make_sweep_folder(const std::filesystem::path& root, const Plan& plan);

/// Opens a planned folder. Throws InputError where it is none, or its request was edited since (it
/// lists what changed).
Plan open_sweep_folder(const SweepFolder& folder);

}  // namespace strut
