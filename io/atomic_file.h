// A file that appears under its name whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace strut {

/// Reserves a temporary file beside `target`; `commit` renames it onto the target, the destructor
/// removes it where that did not happen. All failures are EnvironmentError and name the target.
class AtomicFile {
 public:
  /// Throws where the target's folder is missing or not writable, or the target exists and is not a
  /// regular file (a rename would replace a device or a folder).
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// An existing, empty file to write into.
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }

  /// Flushes the temporary file to the disk and gives it the target's name.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// With those above it, where they are not there. Throws EnvironmentError.
void make_folder(const std::filesystem::path& path);

/// Where it is there. Throws EnvironmentError.
void remove_file(const std::filesystem::path& path);

/// Writes a text file, whole or not at all. Throws EnvironmentError.
void write_text_file(const std::filesystem::path& path, const std::string& text);

}  // namespace strut
