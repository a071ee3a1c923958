// Files that killed runners left in a sweep folder.
#pragma once

#include "io/store/claims.h"
#include "sweep/folder.h"

namespace strut {

/// Removes from tmp/ the files OWNER.NUMBER whose owner is gone, and from claims/ the stale claims
/// that nobody would ask for again: those of shards that are there, and of retries. Claims of
/// unfinished shards are taken over when their turn comes. Then what killed processes left of files
/// in the folder itself. Names that strut does not give are left alone. Throws EnvironmentError;
/// InputError where one of the folders is a link.
void remove_leftovers(const SweepFolder& folder, Claims& claims);

}  // namespace strut
