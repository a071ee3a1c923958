#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <span>
#include <string>

#include "io/file_bytes.h"
#include "io/file_sync.h"

namespace strut {

namespace {

namespace fs = std::filesystem;

// A rename replaces a symbolic link itself; the user means the file behind it.
fs::path resolve_link(const fs::path& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored) ? fs::weakly_canonical(path) : path;
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
  if (descriptor < 0) throw file_failure(target_, "cannot be written", errno);
  ::fchmod(descriptor, new_file_mode());
  ::close(descriptor);
  temporary_ = name;
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  {
    const FileDescriptor file = open_file(temporary_, O_RDONLY);
    if (!file.is_open()) throw file_failure(target_, "cannot be written", errno);
    flush_file(file.get(), target_);
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    throw file_failure(target_, "cannot be written", errno);
  }
  committed_ = true;
  flush_folder_of(target_);
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw EnvironmentError(path.string() + ": cannot be made: " + error.message());
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw EnvironmentError(path.string() + ": cannot be removed: " + error.message());
}

void write_text_file(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  write_bytes(file.temporary(), std::as_bytes(std::span<const char>(text)), path);
  file.commit();
}

}  // namespace strut
