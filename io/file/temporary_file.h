// A file under a temporary name until its content is complete.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// A new file PREFIX.NUMBER in `folder`, with the first free number, that is to become
/// `target_name` in `target_folder`, which must lie on the same file system. All failures are
/// EnvironmentError and name the target.
class TemporaryFile {
 public:
  TemporaryFile(const Folder& folder, const std::string& prefix, const Folder& target_folder,
                const std::string& target_name);
  /// Removes the temporary name.
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(const std::string& text);
  /// Flushes the file to the disk and reads it back; throws if it differs from `bytes`.
  void flush_and_compare(std::span<const std::byte> bytes);

  /// Gives the file the target's name; false if that name is taken. Uses link(2), which never
  /// replaces a file and is atomic on NFS, or renameat2(RENAME_NOREPLACE) if the file system does
  /// not support links.
  bool name_new();
  /// Gives the file the target's name, replacing any file that has it.
  void name_over();

 private:
  FileDescriptor create(const std::string& prefix);
  void make_visible() const;
  bool has_target_name() const;
  bool move_new();

  Folder folder_, target_folder_;
  std::string name_, target_name_;
  std::filesystem::path target_;  // for messages
  FileDescriptor file_;
  bool moved_ = false;  // the temporary name no longer exists
};

}  // namespace strut
