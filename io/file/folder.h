// An open directory, so that its contents are reached through its descriptor and never through a
// path into which somebody has put a symbolic link.
//
// Rule for every folder that strut makes (sweep, study, report, submission): the folder itself may
// be reached through links that the user named; inside it nothing is written through a link, and
// only files with names of strut's own are removed.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/file/file_sync.h"

namespace strut {

class Folder {
 public:
  static constexpr std::size_t kNoLimit = static_cast<std::size_t>(-1);

  /// Opens a directory that the user named, following links. Throws InputError if it is missing or
  /// not a directory, EnvironmentError if it cannot be opened.
  explicit Folder(const std::filesystem::path& path);

  /// Opens a subfolder. Throws InputError if it is missing, a link or not a directory.
  Folder open_folder(const std::string& name) const;
  /// As open_folder, but returns nullopt if the subfolder is missing.
  std::optional<Folder> find_folder(const std::string& name) const;
  /// Makes the subfolder if it is missing and opens it. Throws as open_folder, and
  /// EnvironmentError.
  Folder make_folder(const std::string& name) const;
  /// Makes a subfolder; false if something of that name exists. Throws EnvironmentError.
  bool make_new_folder(const std::string& name) const;

  /// Path for messages.
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path path_of(const std::string& name) const { return path_ / name; }
  /// Descriptor opened with O_PATH, for the system calls whose names end in "at".
  int descriptor() const { return directory_->get(); }

  /// openat(2) of a regular file with O_NOFOLLOW and O_CLOEXEC, never waiting for another process.
  /// The result is not open if there is no such file or, with O_EXCL, if one exists; errno says
  /// which. Throws InputError for a link or anything else that is not a regular file,
  /// EnvironmentError for any other failure.
  FileDescriptor open_file(const std::string& name, int flags) const;
  /// Creates a file; not open if the name is taken. Throws an EnvironmentError that names `target`,
  /// the file that this one is to become.
  FileDescriptor create_file(const std::string& name, int flags,
                             const std::filesystem::path& target) const;
  /// Reads a whole regular file; nullopt if it is missing. Throws as open_file, and InputError if
  /// it is larger than `max_bytes`.
  std::optional<std::string> read_if_present(const std::string& name,
                                             std::size_t max_bytes = kNoLimit) const;

  /// Returns the names in the directory, sorted. Throws EnvironmentError.
  std::vector<std::string> list() const;
  /// Returns whether the name exists; links are not followed.
  bool has(const std::string& name) const;
  /// Removes a file or a link itself, never a directory; does nothing if it is missing. Throws
  /// EnvironmentError.
  void remove(const std::string& name) const;
  /// As remove, but ignores failures.
  void try_remove(const std::string& name) const;
  /// Moves a file of this folder to `target_name` in `target` without replacing anything; false if
  /// that name is taken. Throws EnvironmentError.
  bool move_new(const std::string& name, const Folder& target,
                const std::string& target_name) const;

  /// Flushes the directory to the disk, so that its names survive a power cut. Throws an
  /// EnvironmentError that names `target`.
  void flush(const std::filesystem::path& target) const;

 private:
  Folder(FileDescriptor directory, std::filesystem::path path);

  std::filesystem::path path_;
  std::shared_ptr<const FileDescriptor> directory_;  // copies share it
};

}  // namespace strut
