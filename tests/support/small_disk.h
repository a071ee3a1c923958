// A file system of a given size that is there as long as the object.
#pragma once

#include <sys/mount.h>

#include <filesystem>
#include <string>

namespace strut::test {

/// Only root can mount one: a test without it must say that it was skipped.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& folder, int megabytes) : folder_(folder) {
    std::filesystem::create_directories(folder);
    is_mounted_ = ::mount("strut_test", folder.c_str(), "tmpfs", 0, size(megabytes).c_str()) == 0;
  }
  ~SmallDisk() {
    if (is_mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool is_mounted() const { return is_mounted_; }
  /// False where that fails, as with a file open for writing.
  bool set(int megabytes, bool is_read_only) const {
    constexpr unsigned long kChange = MS_REMOUNT;
    const unsigned long flags = is_read_only ? kChange | MS_RDONLY : kChange;
    return ::mount(nullptr, folder_.c_str(), nullptr, flags, size(megabytes).c_str()) == 0;
  }

 private:
  static std::string size(int megabytes) { return "size=" + std::to_string(megabytes) + "m"; }

  std::filesystem::path folder_;
  bool is_mounted_ = false;
};

}  // namespace strut::test
