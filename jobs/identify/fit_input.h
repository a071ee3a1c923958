// Input of `strut identify` by fit: the measured runs and the unknowns that its options choose.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "estimate/measured_run.h"
#include "estimate/unknown.h"
#include "jobs/cli/arguments.h"

namespace strut {

/// Reads the runs of `files` with --maneuver, --channels, --noise, --columns, --set and --window.
/// Throws InputError.
std::vector<MeasuredRun> read_runs(const Arguments& arguments, const std::filesystem::path& vehicle,
                                   const std::vector<std::filesystem::path>& files);

/// The unknowns of a fit, the parameters first.
struct FitUnknowns {
  std::vector<Unknown> all;
  std::size_t parameter_count = 0;
};

/// Makes the unknowns of --free or --by, --nuisance, --prior and --no-nuisances. Throws InputError.
FitUnknowns make_unknowns(const Arguments& arguments, const std::vector<MeasuredRun>& runs);

}  // namespace strut
