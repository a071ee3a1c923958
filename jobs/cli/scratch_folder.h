// Temporary folders.
#pragma once

#include <filesystem>
#include <string>

namespace strut {

/// A new, empty folder; the destructor removes it with its contents.
class ScratchFolder {
 public:
  /// Creates "`parent`/`prefix`.XXXXXX", X random. Throws EnvironmentError.
  ScratchFolder(const std::filesystem::path& parent, const std::string& prefix);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace strut
