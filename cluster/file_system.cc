#include "cluster/file_system.h"

#include <linux/magic.h>
#include <sys/vfs.h>

#include <array>
#include <cerrno>
#include <utility>

#include "io/file/file_sync.h"

namespace strut {

std::string find_local_file_system(const std::filesystem::path& folder) {
  struct statfs facts {};
  if (::statfs(folder.c_str(), &facts) != 0) {
    throw file_failure(folder, "its file system cannot be determined", errno);
  }
  constexpr long kXfs = 0x58465342, kZfs = 0x2fc12fc1;
  static constexpr std::array<std::pair<long, const char*>, 8> kLocal = {{
      {TMPFS_MAGIC, "tmpfs"},
      {RAMFS_MAGIC, "ramfs"},
      {EXT4_SUPER_MAGIC, "ext4"},
      {BTRFS_SUPER_MAGIC, "btrfs"},
      {F2FS_SUPER_MAGIC, "f2fs"},
      {OVERLAYFS_SUPER_MAGIC, "overlay"},
      {kXfs, "xfs"},
      {kZfs, "zfs"},
  }};
  for (const auto& [magic, name] : kLocal) {
    if (facts.f_type == magic) return name;
  }
  return "";
}

}  // namespace strut
