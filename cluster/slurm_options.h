// Options and script of sbatch.
#pragma once

#include <string>
#include <vector>

#include "cluster/dispatcher.h"

namespace strut::slurm {

/// Returns the options of sbatch for `tasks`. As arguments they are words with any content; in the
/// script they would be lines that Slurm splits.
std::vector<std::string> list_options(const TaskArray& tasks);

/// Checks --memory and --option. Throws InputError unless the memory is a number, with or without a
/// unit, and each option one option of sbatch that strut does not need itself.
void check_words(const Resources& resources);

/// Returns the script for `tasks`.
std::string make_script(const TaskArray& tasks);

}  // namespace strut::slurm
