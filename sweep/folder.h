// Creates and opens sweep folders.
#pragma once

#include <filesystem>

#include "io/store/sweep_folder.h"
#include "sweep/plan.h"

namespace strut {

/// Creates missing subfolders: a copy of a sweep folder may have lost the empty ones. Throws
/// EnvironmentError.
void make_subfolders(const SweepFolder& folder);

/// Creates the folder of a plan: request.toml with copies of every file it names, the empty
/// subfolders and, last, plan.h5, so that a folder is either fully planned or not at all. Planning
/// the same request again only seals a plan.h5 of an earlier version. Throws InputError if `root`
/// holds another plan (the message lists the differences) or foreign files, EnvironmentError if it
/// cannot be written.
SweepFolder make_sweep_folder(const std::filesystem::path& root, const Plan& plan);

/// Opens a planned folder. Throws InputError if it is not one, or if its request was edited since
/// planning (the message lists the differences).
Plan open_sweep_folder(const SweepFolder& folder);

}  // namespace strut
