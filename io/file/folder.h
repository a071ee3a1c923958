// A directory held open, so that what it contains is reached through its descriptor and never
// through a path in which somebody has put a symbolic link.
//
// Rule for every folder that strut makes (sweep, study, report, submission): the folder itself may
// be reached through links that the user named; inside it nothing is written through a link, and
// nothing is removed that strut does not name itself.
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

  /// Opens a directory that the user named, following links. Throws InputError where it is missing
  /// or not a directory, EnvironmentError where it cannot be opened.
  explicit Folder(const std::filesystem::path& path);

  /// Opens a subfolder. Throws InputError where it is missing, a link or not a directory.
  Folder open_folder(const std::string& name) const;
  /// As open_folder; nullopt where it is missing.
  std::optional<Folder> find_folder(const std::string& name) const;
  /// As open_folder, after making the subfolder where it is missing. Throws EnvironmentError.
  Folder make_folder(const std::string& name) const;
  /// Makes a subfolder; false where something of that name exists. Throws EnvironmentError.
  bool make_new_folder(const std::string& name) const;

  /// For messages.
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path path_of(const std::string& name) const { return path_ / name; }
  /// Of the directory, opened with O_PATH: for the system calls whose names end in "at".
  int descriptor() const { return directory_->get(); }

  /// openat(2) of a regular file with O_NOFOLLOW and O_CLOEXEC, never waiting for another process.
  /// Not open: there is no such file, or, with O_EXCL, one exists; errno says which. Throws
  /// InputError for a link or anything that is not a regular file, EnvironmentError for all else.
  FileDescriptor open_file(const std::string& name, int flags) const;
  /// A new file; not open: the name is taken. Throws an EnvironmentError that names `target`, which
  /// the file is for.
  FileDescriptor create_file(const std::string& name, int flags,
                             const std::filesystem::path& target) const;
  /// The content of a regular file; nullopt where it is missing.
  /// Throws as open_file, and InputError where it is larger than `max_bytes`.
  std::optional<std::string> read_if_present(const std::string& name,
                                             std::size_t max_bytes = kNoLimit) const;

  /// Names in the directory, sorted. Throws EnvironmentError.
  std::vector<std::string> list() const;
  /// Whether anything has that name; links are not followed.
  bool has(const std::string& name) const;
  /// Removes a file, or a link itself, never a directory. A missing one is fine. Throws
  /// EnvironmentError.
  void remove(const std::string& name) const;
  /// As remove; what cannot be removed stays.
  void try_remove(const std::string& name) const;
  /// Moves a file of this folder to `target_name` in `target`, replacing nothing; false where that
  /// name is taken. Throws EnvironmentError.
  bool move_new(const std::string& name, const Folder& target,
                const std::string& target_name) const;

  /// Makes the names in it survive a power cut. Throws EnvironmentError that names `target`.
  void flush(const std::filesystem::path& target) const;

 private:
  Folder(FileDescriptor directory, std::filesystem::path path);

  std::filesystem::path path_;
  std::shared_ptr<const FileDescriptor> directory_;  // copies share it
};

}  // namespace strut
