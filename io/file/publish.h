// Files that several runners, perhaps on several hosts, write into one folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

enum class Published {
  kNew,      // the file is ours
  kPresent,  // somebody else's was there first; ours is discarded
};

/// Writes `bytes` to the new file OWNER.NUMBER in the folder `temporary`, flushes it to the disk,
/// reads it back, and gives it the name `name` in `folder` unless a file has that name already: by
/// link(2), which never replaces and which NFS does once; by renameat2(RENAME_NOREPLACE) where
/// links are not supported. Then flushes `folder`. The target is whole or absent at any moment,
/// whatever kills the process or the machine. Throws an EnvironmentError that names the target,
/// with nothing left behind, where anything fails: no space, a limit of file size (no SIGXFSZ
/// reaches the process), a bad disk. Where only the last step fails, the folder's flush, the target
/// stands, whole, but may vanish in a power cut. Both folders lie on one file system.
Published publish(const Folder& folder, const std::string& name, std::span<const std::byte> bytes,
                  const Folder& temporary, const std::string& owner);

}  // namespace strut
