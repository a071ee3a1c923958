// Provenance of the files that commands write.
#pragma once

#include "io/format/named_texts.h"

namespace strut {

/// Version and commit of this program, as attributes of a file.
NamedTexts make_provenance();

}  // namespace strut
