// Version, commit and compiler of this program, for `--version` and for the provenance of the files
// it writes.
#pragma once

namespace strut {

struct BuildInfo {
  const char* version;     // e.g. "0.1.0"
  const char* commit;      // `git describe --always --dirty`, "unknown" outside a checkout
  const char* compiler;    // e.g. "GNU 12.2.0"
  const char* build_type;  // e.g. "Release"
};

/// Returns the values of the time at which the program was linked.
const BuildInfo& get_build_info();

}  // namespace strut
