// Provenance of the files that commands write.
#pragma once

#include "io/format/named_texts.h"

namespace strut {

/// Version and commit of this program, as attributes of a file.
NamedTexts make_provenance();

/// Version, commit and compiler of this program, and the name of this host, as attributes of every
/// shard.
NamedTexts make_run_provenance();

}  // namespace strut
