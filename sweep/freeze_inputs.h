// Copies a request with every file it names, so that a sweep is independent of the originals.
#pragma once

#include "sweep/folder.h"

namespace strut {

/// Writes request.toml and request/ with the vehicle, the maneuver and the files that these name.
/// Texts are copied verbatim, comments included, except for paths, which then lead to the copies:
/// the folder may be moved, and `strut simulate` accepts the files in request/. Throws
/// EnvironmentError.
void freeze_inputs(const SweepRequest& request, const SweepFolder& folder);

}  // namespace strut
