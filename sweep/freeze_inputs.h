// A request with every file it names, copied to where it is independent of the originals.
#pragma once

#include "sweep/folder.h"

namespace strut {

/// Writes request.toml and request/ with the vehicle, the maneuver and the files these name. Texts
/// stay as they are, comments included, but for the paths, which now lead to the copies: the folder
/// may be moved, and `strut simulate` takes what is in request/. Throws EnvironmentError.
void freeze_inputs(const SweepRequest& request, const SweepFolder& folder);

}  // namespace strut
