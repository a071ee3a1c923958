// The kinds of TOML files, told apart by a key that only one of them has, so that a file in
// another's place is named as what it is.
#pragma once

#include "io/format/toml_document.h"

namespace strut {

struct FileKind {
  const char* name;  // "maneuver of a car"
  const char* key;   // at the top of every such file
};

inline constexpr FileKind kModelFile{"vehicle or rig", "type"};
inline constexpr FileKind kManeuverFile{"maneuver of a car", "bump"};
inline constexpr FileKind kRigManeuverFile{"maneuver of a rig", "input"};
inline constexpr FileKind kSweepFile{"sweep", "grid"};
inline constexpr FileKind kCampaignFile{"campaign", "run"};
inline constexpr FileKind kStudyFile{"study", "networks"};

/// Returns the file's root. Throws InputError "PATH: a sweep; must be a maneuver of a car" for a
/// file that is of another kind and not of this one.
Table open_root(const Document& document, const FileKind& kind);

}  // namespace strut
