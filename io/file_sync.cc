#include "io/file_sync.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

namespace strut {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNotWritten = "cannot be written";

// A write beyond the limit of file size sends SIGXFSZ to the thread that wrote, which by default
// ends the process. Blocking it touches this thread only; ignoring it would change the whole
// process under other threads' hands.
class HeldBackSizeSignal {
 public:
  HeldBackSizeSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGXFSZ);
    was_pending_ = is_pending();
    ::pthread_sigmask(SIG_BLOCK, &signal_, &old_mask_);
  }
  ~HeldBackSizeSignal() {
    const int error_number = errno;
    constexpr timespec kNow{};
    if (!was_pending_ && is_pending()) ::sigtimedwait(&signal_, nullptr, &kNow);
    ::pthread_sigmask(SIG_SETMASK, &old_mask_, nullptr);
    errno = error_number;
  }
  HeldBackSizeSignal(const HeldBackSizeSignal&) = delete;
  HeldBackSizeSignal& operator=(const HeldBackSizeSignal&) = delete;

 private:
  static bool is_pending() {
    sigset_t pending;
    sigemptyset(&pending);
    ::sigpending(&pending);
    return sigismember(&pending, SIGXFSZ) == 1;
  }

  sigset_t signal_{};
  sigset_t old_mask_{};
  bool was_pending_ = false;
};

FileDescriptor create_numbered(const fs::path& prefix, const fs::path& target, fs::path& path) {
  for (int number = 0;; ++number) {
    path = prefix.string() + "." + std::to_string(number);
    FileDescriptor file = open_file(path, O_RDWR | O_CREAT | O_EXCL);
    if (file.is_open()) return file;
    if (errno != EEXIST) throw file_failure(target, kNotWritten, errno);
  }
}

}  // namespace

EnvironmentError file_failure(const fs::path& path, const std::string& what, int error_number) {
  return EnvironmentError(path.string() + ": " + what + ": " + std::strerror(error_number));
}

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

FileDescriptor open_file(const fs::path& path, int flags) {
  for (;;) {
    const int number = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (number >= 0 || errno != EINTR) return FileDescriptor(number);
  }
}

std::optional<std::string> read_if_present(const fs::path& path) {
  const FileDescriptor file = open_file(path, O_RDONLY);
  if (!file.is_open()) {
    if (errno == ENOENT) return std::nullopt;
    throw file_failure(path, "cannot be read", errno);
  }
  std::string text;
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    if (count == 0) return text;
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    // Another host removed or replaced the file while it was open here.
    if (count < 0 && errno == ESTALE) return read_if_present(path);
    if (count < 0 && errno != EINTR) throw file_failure(path, "cannot be read", errno);
  }
}

std::ptrdiff_t write_once(int descriptor, std::span<const std::byte> bytes) {
  const HeldBackSizeSignal held_back;
  for (;;) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0 || errno != EINTR) return written;
  }
}

void write_all(int descriptor, std::span<const std::byte> bytes, const fs::path& target) {
  while (!bytes.empty()) {
    const std::ptrdiff_t written = write_once(descriptor, bytes);
    if (written < 0) throw file_failure(target, kNotWritten, errno);
    if (written == 0) throw file_failure(target, kNotWritten, ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void flush_file(int descriptor, const fs::path& target) {
  while (::fsync(descriptor) != 0) {
    if (errno == EINVAL || errno == ENOTSUP) return;
    if (errno != EINTR) throw file_failure(target, "cannot be flushed to the disk", errno);
  }
}

void flush_folder_of(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const FileDescriptor file = open_file(folder, O_RDONLY | O_DIRECTORY);
  if (file.is_open()) {
    flush_file(file.get(), target);
  } else if (errno != EACCES) {  // a folder may be writable but not readable
    throw file_failure(target, "cannot be flushed to the disk", errno);
  }
}

TemporaryFile::TemporaryFile(const fs::path& prefix, const fs::path& target)
    : target_(target), file_(create_numbered(prefix, target, path_)) {}

TemporaryFile::~TemporaryFile() {
  if (!moved_) ::unlink(path_.c_str());
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
  write_all(file_.get(), bytes, target_);
}

void TemporaryFile::write(const std::string& text) { write(std::as_bytes(std::span(text))); }

void TemporaryFile::flush_and_compare(std::span<const std::byte> bytes) {
  flush_file(file_.get(), target_);
  // Else the comparison meets the copy in memory.
  ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
  // One byte more than there should be, to see a file that is too long.
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
      throw EnvironmentError(target_.string() + ": the disk gives back other bytes than written");
    }
    done += n;
  }
  if (done != bytes.size()) {
    throw EnvironmentError(target_.string() + ": the disk gives back fewer bytes than written");
  }
}

// A network file system may do what was asked and lose the answer, so that the repeated request is
// refused: only the file under the name tells.
bool TemporaryFile::has_target_name() const {
  struct stat ours {
  }, theirs{};
  return ::fstat(file_.get(), &ours) == 0 && ::stat(target_.c_str(), &theirs) == 0 &&
         ours.st_dev == theirs.st_dev && ours.st_ino == theirs.st_ino;
}

// On a network file system others see what was written once it is closed; closing a copy of the
// descriptor is enough. Elsewhere it costs nothing.
void TemporaryFile::hand_over() const {
  int result = -1;
  do {
    const int copy = ::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0);
    result = copy < 0 ? -1 : ::close(copy);
  } while (result != 0 && errno == EINTR);
  if (result != 0) throw file_failure(target_, kNotWritten, errno);
}

bool TemporaryFile::name_new() {
  hand_over();
  if (::link(path_.c_str(), target_.c_str()) == 0) return true;
  const int error_number = errno;
  if (error_number == EPERM || error_number == EOPNOTSUPP || error_number == ENOSYS) {
    return move_new();
  }
  if (has_target_name()) return true;
  if (error_number != EEXIST) throw file_failure(target_, kNotWritten, error_number);
  return false;
}

bool TemporaryFile::move_new() {
  const bool done =
      ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0;
  const int error_number = errno;
  moved_ = done || has_target_name();
  if (!moved_ && error_number != EEXIST) {
    throw file_failure(target_, "cannot be named (neither by link nor by renameat2)", error_number);
  }
  return moved_;
}

void TemporaryFile::name_over() {
  hand_over();
  if (::rename(path_.c_str(), target_.c_str()) != 0 && !has_target_name()) {
    throw file_failure(target_, kNotWritten, errno);
  }
  moved_ = true;
}

}  // namespace strut
