#include "io/file/file_bytes.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace strut {

namespace fs = std::filesystem;

std::vector<std::byte> read_from(const FileDescriptor& file, const fs::path& path,
                                 std::size_t count) {
  std::vector<std::byte> bytes(count);
  std::size_t done = 0;
  while (done < count) {
    const ssize_t step = ::read(file.get(), bytes.data() + done, count - done);
    if (step < 0 && errno == EINTR) continue;
    if (step < 0) throw file_failure(path, kNotRead, errno);
    if (step == 0) break;
    done += static_cast<std::size_t>(step);
  }
  bytes.resize(done);
  return bytes;
}

std::size_t read_size(const FileDescriptor& file, const fs::path& path) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw file_failure(path, kNotRead, errno);
  return static_cast<std::size_t>(status.st_size);
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  const FileDescriptor file = open_regular_file(path);
  return read_from(file, path, read_size(file, path));
}

}  // namespace strut
