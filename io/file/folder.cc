#include "io/file/folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr int kDirectoryFlags = O_PATH | O_DIRECTORY | O_CLOEXEC;

// A name that a caller took from a file must not lead elsewhere.
void check_name(const Folder& folder, const std::string& name) {
  const bool is_plain = !name.empty() && name != "." && name != ".." &&
                        name.find_first_of(std::string("/\0", 2)) == std::string::npos;
  if (is_plain) return;
  throw InputError(
      fmt::format("{}: '{}': not a file name; must be one without '/', not '.' or '..'",
                  folder.path().string(), name));
}

FileDescriptor open_at(int directory, const char* name, int flags) {
  for (;;) {
    const int number = ::openat(directory, name, flags, 0666);
    if (number >= 0 || errno != EINTR) return FileDescriptor(number);
  }
}

bool is_link(const Folder& folder, const std::string& name) {
  struct stat status {};
  return ::fstatat(folder.descriptor(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 &&
         S_ISLNK(status.st_mode);
}

InputError missing_folder_error(const fs::path& path) {
  return InputError(path.string() + ": no such folder");
}

InputError link_error(const fs::path& path) {
  return InputError(path.string() +
                    ": a symbolic link; inside a folder that strut writes it must not be one: "
                    "replace it by its target, or remove it");
}

}  // namespace

Folder::Folder(const fs::path& path) : path_(path.empty() ? fs::path(".") : path) {
  FileDescriptor directory = strut::open_file(path_, kDirectoryFlags);
  if (!directory.is_open() && errno == ENOENT) throw missing_folder_error(path_);
  if (!directory.is_open() && errno == ENOTDIR) {
    throw InputError(path_.string() + ": not a folder");
  }
  if (!directory.is_open()) throw file_failure(path_, "cannot be opened", errno);
  directory_ = std::make_shared<const FileDescriptor>(std::move(directory));
}

Folder::Folder(FileDescriptor directory, fs::path path)
    : path_(std::move(path)),
      directory_(std::make_shared<const FileDescriptor>(std::move(directory))) {}

std::optional<Folder> Folder::find_folder(const std::string& name) const {
  check_name(*this, name);
  FileDescriptor directory = open_at(descriptor(), name.c_str(), kDirectoryFlags | O_NOFOLLOW);
  if (directory.is_open()) return Folder(std::move(directory), path_of(name));
  const int error_number = errno;
  if (error_number == ENOENT) return std::nullopt;
  if (is_link(*this, name)) throw link_error(path_of(name));
  if (error_number == ENOTDIR) {
    throw InputError(path_of(name).string() + ": not a folder; must be one: remove or rename it");
  }
  throw file_failure(path_of(name), "cannot be opened", error_number);
}

Folder Folder::open_folder(const std::string& name) const {
  std::optional<Folder> folder = find_folder(name);
  if (!folder) throw missing_folder_error(path_of(name));
  return *std::move(folder);
}

bool Folder::make_new_folder(const std::string& name) const {
  check_name(*this, name);
  if (::mkdirat(descriptor(), name.c_str(), 0777) == 0) return true;
  if (errno != EEXIST) throw file_failure(path_of(name), kNotMade, errno);
  return false;
}

Folder Folder::make_folder(const std::string& name) const {
  make_new_folder(name);
  return open_folder(name);
}

FileDescriptor Folder::open_file(const std::string& name, int flags) const {
  check_name(*this, name);
  FileDescriptor file =
      open_at(descriptor(), name.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file.is_open()) {
    check_regular(file.get(), path_of(name));
    return file;
  }
  const int error_number = errno;
  const bool is_excluded = error_number == EEXIST && (flags & O_EXCL) != 0;
  if (!is_excluded && error_number != ENOENT) {
    if (is_link(*this, name)) throw link_error(path_of(name));
    check_regular(descriptor(), name, path_of(name));
    throw file_failure(path_of(name), "cannot be opened", error_number);
  }
  errno = error_number;
  return file;
}

FileDescriptor Folder::create_file(const std::string& name, int flags,
                                   const fs::path& target) const {
  check_name(*this, name);
  FileDescriptor file =
      open_at(descriptor(), name.c_str(), flags | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC);
  if (!file.is_open() && errno != EEXIST) throw file_failure(target, kNotWritten, errno);
  return file;
}

std::optional<std::string> Folder::read_if_present(const std::string& name,
                                                   std::size_t max_bytes) const {
  for (;;) {
    const FileDescriptor file = open_file(name, O_RDONLY);
    if (!file.is_open()) return std::nullopt;
    struct stat status {};
    ::fstat(file.get(), &status);
    if (static_cast<std::size_t>(status.st_size) > max_bytes) {
      throw InputError(fmt::format("{}: {} bytes; at most {} are allowed", path_of(name).string(),
                                   status.st_size, max_bytes));
    }
    if (auto text = read_rest(file.get(), path_of(name))) return text;
  }
}

std::vector<std::string> Folder::list() const {
  // A separate descriptor, since reading a directory moves the position.
  const int number = ::openat(descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR* const directory = number < 0 ? nullptr : ::fdopendir(number);
  if (directory == nullptr) {
    const int error_number = errno;
    if (number >= 0) ::close(number);
    throw file_failure(path_, "cannot be listed", error_number);
  }
  std::vector<std::string> names;
  int error_number = 0;
  for (;;) {
    errno = 0;
    const dirent* const entry = ::readdir(directory);
    error_number = errno;
    if (entry == nullptr) break;
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  ::closedir(directory);
  if (error_number != 0) throw file_failure(path_, "cannot be listed", error_number);
  std::sort(names.begin(), names.end());
  return names;
}

bool Folder::has(const std::string& name) const {
  struct stat status {};
  return ::fstatat(descriptor(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

void Folder::remove(const std::string& name) const {
  check_name(*this, name);
  if (::unlinkat(descriptor(), name.c_str(), 0) != 0 && errno != ENOENT) {
    throw file_failure(path_of(name), "cannot be removed", errno);
  }
}

void Folder::try_remove(const std::string& name) const {
  ::unlinkat(descriptor(), name.c_str(), 0);
}

bool Folder::move_new(const std::string& name, const Folder& target,
                      const std::string& target_name) const {
  check_name(*this, name);
  check_name(target, target_name);
  if (::renameat2(descriptor(), name.c_str(), target.descriptor(), target_name.c_str(),
                  RENAME_NOREPLACE) == 0) {
    return true;
  }
  // Network file systems do not support the flag; there it suffices that the name is free now.
  const bool is_unsupported = errno == EINVAL || errno == ENOSYS;
  if (is_unsupported && !target.has(target_name) &&
      ::renameat(descriptor(), name.c_str(), target.descriptor(), target_name.c_str()) == 0) {
    return true;
  }
  if (is_unsupported && target.has(target_name)) return false;
  if (errno != EEXIST) throw file_failure(path_of(name), "cannot be moved aside", errno);
  return false;
}

void Folder::flush(const fs::path& target) const {
  const FileDescriptor directory = open_at(descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory.is_open()) {
    flush_file(directory.get(), target);
  } else if (errno != EACCES) {  // a folder may be writable but not readable
    throw file_failure(target, kNotFlushed, errno);
  }
}

}  // namespace strut
