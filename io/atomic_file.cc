#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "io/input_error.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

EnvironmentError failure(const fs::path& target, const std::string& what, int error_number) {
  return EnvironmentError(target.string() + ": " + what + ": " + std::strerror(error_number));
}

// A rename replaces a symbolic link itself; the user means the file behind it.
fs::path resolve_link(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path) : path;
}

// Makes a rename in `folder` survive a power cut. File systems that cannot do it say so; the file
// itself is complete either way.
void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

// mkstemp makes files that only their owner reads; the result gets what any new file would get.
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(resolve_link(target)) {
  if (fs::exists(target_) && !fs::is_regular_file(target_)) {
    throw EnvironmentError(target_.string() + ": cannot be written: not a regular file");
  }
  std::string name = target_.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) throw failure(target_, "cannot be written", errno);
  ::fchmod(descriptor, new_file_mode());
  ::close(descriptor);
  temporary_ = name;
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  const int descriptor = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw failure(target_, "cannot be written", errno);
  const int flushed = ::fsync(descriptor);
  const int error_number = errno;
  ::close(descriptor);
  // EINVAL: a file system without flush.
  if (flushed != 0 && error_number != EINVAL) {
    throw failure(target_, "cannot be written", error_number);
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw failure(target_, "cannot be written", errno);
  }
  committed_ = true;
  flush_folder(target_.has_parent_path() ? target_.parent_path() : fs::path("."));
}

}  // namespace strut
