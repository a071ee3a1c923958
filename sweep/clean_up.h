// Removes what killed runners left in a sweep folder.
#pragma once

#include "io/store/claims.h"
#include "sweep/folder.h"

namespace strut {

/// Removes from tmp/ the files OWNER.NUMBER whose owner is dead; from claims/ the stale claims that
/// no runner would request again: those on published shards and on retries (claims on unfinished
/// shards are taken over when their turn comes); and abandoned temporary files from the folder
/// itself. Files that strut did not name are left alone. Throws EnvironmentError; InputError if one
/// of the folders is a link.
void clean_up(const SweepFolder& folder, Claims& claims);

}  // namespace strut
