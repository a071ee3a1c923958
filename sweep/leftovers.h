// What killed runners have left in a sweep folder.
#pragma once

#include "io/claims.h"
#include "sweep/folder.h"

namespace strut {

/// Removes from tmp/ the files OWNER.NUMBER whose owner is gone, and from claims/ the stale claims
/// that nobody would ask for again: those of shards that are there, and of retries. Claims of
/// unfinished shards are taken over when their turn comes. Throws EnvironmentError.
void remove_leftovers(const SweepFolder& folder, Claims& claims);

}  // namespace strut
