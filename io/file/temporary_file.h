// A file on the way to the name it is for.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// A new file PREFIX.NUMBER in `folder`, with the first number that is free, that is to become
/// `target_name` in `target_folder`; both lie on one file system. All failures are EnvironmentError
/// and name the target.
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
  /// Flushes to the disk, and reads from there: throws where that is not `bytes`.
  void flush_and_compare(std::span<const std::byte> bytes);

  /// Gives the file, with all that was written, the target's name; false where that name is taken.
  /// By link(2), which never replaces and which NFS does once; by renameat2(RENAME_NOREPLACE) where
  /// the file system knows no links.
  bool name_new();
  /// Gives the file the target's name, replacing what has it.
  void name_over();

 private:
  FileDescriptor create(const std::string& prefix);
  void hand_over() const;
  bool has_target_name() const;
  bool move_new();

  Folder folder_, target_folder_;
  std::string name_, target_name_;
  std::filesystem::path target_;  // for messages
  FileDescriptor file_;
  bool moved_ = false;  // the temporary name is gone already
};

}  // namespace strut
