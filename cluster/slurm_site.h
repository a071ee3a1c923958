// Partitions, limits and capabilities of a Slurm site; for the files of SlurmDispatcher only.
#pragma once

#include <filesystem>
#include <string>

#include "cluster/dispatcher.h"

namespace strut::slurm {

struct Partition {
  std::string name;
  double seconds = 0.0;  // time limit
  bool is_up = false;
};

/// Finds the partition `wanted`, or the site's default if that is "". Throws InputError if there is
/// none, EnvironmentError if Slurm does not answer.
Partition find_partition(const std::string& wanted);

/// Returns the limits of the site for a submission. Throws as Dispatcher::check() does.
SiteLimits check_site(const Resources& resources, const std::filesystem::path& folder);

/// Reports what works on the site and what does not.
Findings examine_site(const Resources& resources, const std::filesystem::path& folder);

}  // namespace strut::slurm
