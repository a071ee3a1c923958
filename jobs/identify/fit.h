// `strut identify` by fitting the simulation to measured histories: its options and its run.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/cli/arguments.h"

namespace strut {

/// --maneuver, --free, --by, --channels, --window, --nuisance, --prior, --no-nuisances, --threads.
/// A fit also reads --noise and --set, which add_snapshot_options adds.
void add_fit_options(Arguments& arguments);

/// Throws InputError where one of them is given; other methods would ignore it.
void refuse_fit_options(const Arguments& arguments);

/// Fits the car in `vehicle` to the histories in `files`, prints and writes. Returns an exit code:
/// kExitNegative where the fit has not converged, leaves a parameter
/// undetermined, or holds one at a bound.
/// Throws InputError.
int identify_by_fit(const Arguments& arguments, const std::filesystem::path& vehicle,
                    const std::vector<std::filesystem::path>& files);

}  // namespace strut
