// A file that appears under its name whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// Reserves a temporary file beside `target`; `commit` renames it onto the target, the destructor
/// removes it if that did not happen. The temporary file of a killed process is removed by the next
/// AtomicFile of that target, or by remove_abandoned_files. Failures are EnvironmentError and name
/// the target.
class AtomicFile {
 public:
  /// For a file that the user named; if it is a link, the file behind the link is replaced. Throws
  /// if the target's folder is missing or not writable, or if the target exists and is not a
  /// regular file (a rename would replace a device or a folder).
  explicit AtomicFile(const std::filesystem::path& target);
  /// For a file inside a folder that strut makes. Throws InputError if the name belongs to a link
  /// or to anything else that is not a regular file.
  AtomicFile(const Folder& folder, const std::string& name);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::span<const std::byte> bytes);
  /// Path of the temporary file, which exists, for libraries that open files by name.
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

/// Removes from `folder` the temporary files of AtomicFile whose targets begin with `prefix` and
/// whose processes, started on this host since its last boot, have ended. A file that cannot be
/// removed stays.
void remove_abandoned_files(const Folder& folder, const std::string& prefix = "");

/// Makes a folder and its missing parents. Throws EnvironmentError.
void make_folder(const std::filesystem::path& path);

/// Writes a text file through an AtomicFile, and throws as that does.
void write_text_file(const std::filesystem::path& path, const std::string& text);
void write_text_file(const Folder& folder, const std::string& name, const std::string& text);

/// Writes a text file in or below `root`, a folder that strut makes. Throws InputError if the file
/// or a folder on the way to it is a link, otherwise as AtomicFile does.
void write_text_file_inside(const std::filesystem::path& root, const std::filesystem::path& file,
                            const std::string& text);

/// Removes such a file if it exists; a link itself, not what it leads to. Throws likewise.
void remove_file_inside(const std::filesystem::path& root, const std::filesystem::path& file);

}  // namespace strut
