#include "io/file/file_sync.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace strut {

namespace {

namespace fs = std::filesystem;

// A write beyond the limit on file size sends SIGXFSZ to the writing thread, which by default ends
// the process. Blocking the signal affects this thread only; ignoring it would affect all threads.
class BlockedSizeSignal {
 public:
  BlockedSizeSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGXFSZ);
    was_pending_ = is_pending();
    ::pthread_sigmask(SIG_BLOCK, &signal_, &old_mask_);
  }
  ~BlockedSizeSignal() {
    const int error_number = errno;
    constexpr timespec kNow{};
    if (!was_pending_ && is_pending()) ::sigtimedwait(&signal_, nullptr, &kNow);
    ::pthread_sigmask(SIG_SETMASK, &old_mask_, nullptr);
    errno = error_number;
  }
  BlockedSizeSignal(const BlockedSizeSignal&) = delete;
  BlockedSizeSignal& operator=(const BlockedSizeSignal&) = delete;

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

void require_regular(mode_t mode, const fs::path& path) {
  if (S_ISREG(mode)) return;
  const char* const kind = S_ISDIR(mode)                    ? "a folder"
                           : S_ISFIFO(mode)                 ? "a named pipe"
                           : S_ISCHR(mode) || S_ISBLK(mode) ? "a device"
                           : S_ISSOCK(mode)                 ? "a socket"
                                                            : "a symbolic link";
  throw InputError(fmt::format("{}: {}; must be a regular file", path.string(), kind));
}

}  // namespace

EnvironmentError file_failure(const fs::path& path, const std::string& what, int error_number) {
  return EnvironmentError(
      fmt::format("{}: {}: {}", path.string(), what, std::strerror(error_number)));
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

void check_regular(int descriptor, const fs::path& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) throw file_failure(path, kNotRead, errno);
  require_regular(status.st_mode, path);
}

void check_regular(int directory, const std::string& name, const fs::path& path) {
  struct stat status {};
  if (::fstatat(directory, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return;
  require_regular(status.st_mode, path);
}

FileDescriptor open_regular_file(const fs::path& path) {
  FileDescriptor file = open_file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (!file.is_open()) {
    const int error_number = errno;
    if (error_number == ENOENT) throw InputError(path.string() + ": file not found");
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) require_regular(status.st_mode, path);
    throw file_failure(path, kNotRead, error_number);
  }
  check_regular(file.get(), path);
  return file;
}

std::optional<std::string> read_if_present(const fs::path& path) {
  for (;;) {
    const FileDescriptor file = open_file(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
    if (!file.is_open()) {
      if (errno == ENOENT) return std::nullopt;
      throw file_failure(path, kNotRead, errno);
    }
    check_regular(file.get(), path);
    if (auto text = read_rest(file.get(), path)) return text;
  }
}

std::optional<std::string> read_rest(int descriptor, const fs::path& path) {
  std::string text;
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count == 0) return text;
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno == ESTALE) return std::nullopt;
    if (count < 0 && errno != EINTR) throw file_failure(path, kNotRead, errno);
  }
}

std::ptrdiff_t write_once(int descriptor, std::span<const std::byte> bytes) {
  const BlockedSizeSignal blocked;
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
    if (errno != EINTR) throw file_failure(target, kNotFlushed, errno);
  }
}

}  // namespace strut
