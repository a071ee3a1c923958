#include "io/file_bytes.h"

#include <fcntl.h>

#include <cerrno>
#include <fstream>
#include <string>

#include "io/file_sync.h"

namespace strut {

namespace fs = std::filesystem;

void write_bytes(const fs::path& path, std::span<const std::byte> bytes, const fs::path& shown) {
  const FileDescriptor file = open_file(path, O_WRONLY | O_TRUNC);
  if (!file.is_open()) throw file_failure(shown, "cannot be written", errno);
  write_all(file.get(), bytes, shown);
}

std::vector<std::byte> read_first_bytes(const fs::path& path, std::size_t count) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path.string() + ": file not found or not readable");
  std::vector<std::byte> bytes(count);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  if (stream.bad()) throw InputError(path.string() + ": cannot be read");
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) throw InputError(path.string() + ": file not found or not readable");
  return read_first_bytes(path, size);
}

}  // namespace strut
