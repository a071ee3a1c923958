// Publishes files into a folder that several runners, perhaps on several hosts, write to.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

enum class Published {
  kNew,      // our file has the name
  kPresent,  // another runner's file had it first; ours is discarded
};

/// Writes `bytes` to the new file OWNER.NUMBER in the folder `temporary`, flushes it to the disk,
/// reads it back, and gives it the name `name` in `folder` unless that name is taken: by link(2),
/// which never replaces a file and is atomic on NFS, or by renameat2(RENAME_NOREPLACE) if links are
/// not supported. Then flushes `folder`. The target is whole or absent at any moment, even if the
/// process is killed or the power fails. Any failure (no space, a limit on file size, a bad disk)
/// throws an EnvironmentError that names the target and leaves no file behind; no SIGXFSZ reaches
/// the process. If only the final flush of the folder fails, the target is whole but may vanish in
/// a power cut. Both folders must lie on one file system.
Published publish(const Folder& folder, const std::string& name, std::span<const std::byte> bytes,
                  const Folder& temporary, const std::string& owner);

}  // namespace strut
