#include "io/file/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

namespace strut {

TemporaryFile::TemporaryFile(const Folder& folder, const std::string& prefix,
                             const Folder& target_folder, const std::string& target_name)
    : folder_(folder),
      target_folder_(target_folder),
      target_name_(target_name),
      target_(target_folder.path_of(target_name)),
      file_(create(prefix)) {}

TemporaryFile::~TemporaryFile() {
  if (!moved_) folder_.try_remove(name_);
}

FileDescriptor TemporaryFile::create(const std::string& prefix) {
  for (int number = 0;; ++number) {
    name_ = fmt::format("{}.{}", prefix, number);
    FileDescriptor file = folder_.create_file(name_, O_RDWR, target_);
    if (file.is_open()) return file;
  }
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  write_all(file_.get(), bytes, target_);
}

void TemporaryFile::write(const std::string& text) { write(std::as_bytes(std::span(text))); }

void TemporaryFile::flush_and_compare(std::span<const std::byte> bytes) {
  flush_file(file_.get(), target_);
  // Otherwise the comparison would read the page cache.
  ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
  // One byte more than expected, to detect a file that is too long.
  std::vector<std::byte> buffer(std::min<std::size_t>(bytes.size() + 1, std::size_t{1} << 20));
  std::size_t done = 0;
  for (;;) {
    const ssize_t count =
        ::pread(file_.get(), buffer.data(), buffer.size(), static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw file_failure(target_, "cannot be read back", errno);
    if (count == 0) break;
    const auto n = static_cast<std::size_t>(count);
    if (n > bytes.size() - done || std::memcmp(buffer.data(), bytes.data() + done, n) != 0) {
      throw EnvironmentError(target_.string() + ": the disk returned other bytes than written");
    }
    done += n;
  }
  if (done != bytes.size()) {
    throw EnvironmentError(target_.string() + ": the disk returned fewer bytes than written");
  }
}

// A network file system may carry out a request and lose the answer, so that the repeated request
// fails: only the file under the name shows the outcome.
bool TemporaryFile::has_target_name() const {
  struct stat ours {
  }, theirs{};
  return ::fstat(file_.get(), &ours) == 0 &&
         ::fstatat(target_folder_.descriptor(), target_name_.c_str(), &theirs,
                   AT_SYMLINK_NOFOLLOW) == 0 &&
         ours.st_dev == theirs.st_dev && ours.st_ino == theirs.st_ino;
}

// On a network file system other hosts see the content once the file is closed; closing a copy of
// the descriptor suffices. Elsewhere it costs nothing.
void TemporaryFile::make_visible() const {
  int result = -1;
  do {
    const int copy = ::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0);
    result = copy < 0 ? -1 : ::close(copy);
  } while (result != 0 && errno == EINTR);
  if (result != 0) throw file_failure(target_, kNotWritten, errno);
}

bool TemporaryFile::name_new() {
  make_visible();
  if (::linkat(folder_.descriptor(), name_.c_str(), target_folder_.descriptor(),
               target_name_.c_str(), 0) == 0) {
    return true;
  }
  const int error_number = errno;
  if (error_number == EPERM || error_number == EOPNOTSUPP || error_number == ENOSYS) {
    return move_new();
  }
  if (has_target_name()) return true;
  if (error_number != EEXIST) throw file_failure(target_, kNotWritten, error_number);
  return false;
}

bool TemporaryFile::move_new() {
  const bool done = ::renameat2(folder_.descriptor(), name_.c_str(), target_folder_.descriptor(),
                                target_name_.c_str(), RENAME_NOREPLACE) == 0;
  const int error_number = errno;
  moved_ = done || has_target_name();
  if (!moved_ && error_number != EEXIST) {
    throw file_failure(target_, "cannot be given its name, neither by link nor by renameat2",
                       error_number);
  }
  return moved_;
}

void TemporaryFile::name_over() {
  make_visible();
  if (::renameat(folder_.descriptor(), name_.c_str(), target_folder_.descriptor(),
                 target_name_.c_str()) != 0 &&
      !has_target_name()) {
    throw file_failure(target_, kNotWritten, errno);
  }
  moved_ = true;
}

}  // namespace strut
