// A file that appears under its name whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// Reserves a temporary file beside `target`; `commit` renames it onto the target, the destructor
/// removes it where that did not happen. What a process that was killed left of it goes with the
/// next AtomicFile of that target, or with remove_abandoned_files. Failures are EnvironmentError
/// and name the target.
class AtomicFile {
 public:
  /// For a file that the user named: of a link, the file behind it is replaced. Throws where the
  /// target's folder is missing or not writable, or the target exists and is not a regular file (a
  /// rename would replace a device or a folder).
  explicit AtomicFile(const std::filesystem::path& target);
  /// For a file inside a folder that strut makes. Throws InputError where a link, or anything else
  /// that is not a regular file, has the name.
  AtomicFile(const Folder& folder, const std::string& name);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  /// An existing, empty file to write into, for libraries that open files by name.
  std::filesystem::path temporary() const { return folder_.path_of(temporary_name_); }
  const std::filesystem::path& target() const { return target_; }

  /// Flushes the temporary file to the disk and gives it the target's name.
  void commit();

 private:
  void create();

  std::filesystem::path target_;  // for messages
  Folder folder_;
  std::string name_, temporary_name_;
  FileDescriptor file_;
  bool committed_ = false;
};

/// Removes from `folder` the temporary files of AtomicFile whose process ended on this host since
/// it was started; of the targets whose names begin with `prefix`. What cannot be removed stays.
void remove_abandoned_files(const Folder& folder, const std::string& prefix = "");

/// With those above it, where they are not there. Throws EnvironmentError.
void make_folder(const std::filesystem::path& path);

/// Writes a text file, whole or not at all. Throws as AtomicFile does.
void write_text_file(const std::filesystem::path& path, const std::string& text);
void write_text_file(const Folder& folder, const std::string& name, const std::string& text);

/// Writes a text file that lies in `root`, a folder that strut makes, or below it. Throws
/// InputError where the file or a folder between is a link, otherwise as AtomicFile does.
void write_text_file_inside(const std::filesystem::path& root, const std::filesystem::path& file,
                            const std::string& text);

/// Removes such a file where it exists; of a link the link itself. Throws likewise.
void remove_file_inside(const std::filesystem::path& root, const std::filesystem::path& file);

}  // namespace strut
