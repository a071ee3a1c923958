// Options and script of sbatch; for the files of SlurmDispatcher only.
#pragma once

#include <string>
#include <vector>

#include "cluster/dispatcher.h"

namespace strut::slurm {

/// Returns the options of sbatch for `tasks`. As arguments they are words with any content; in the
/// script they would be lines that Slurm splits.
std::vector<std::string> list_options(const TaskArray& tasks);

/// Checks a value of --option. Throws InputError unless it is one option of sbatch that strut does
/// not need itself.
void check_option(const std::string& option);

/// Returns the script for `tasks`.
std::string make_script(const TaskArray& tasks);

}  // namespace strut::slurm
