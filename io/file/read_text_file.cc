#include "io/file/read_text_file.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "io/file/file_sync.h"

namespace strut {

namespace fs = std::filesystem;

std::string read_text_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code error;  // reported by the read below
  if (const auto size = fs::file_size(path, error); !error && size > max_bytes) {
    throw InputError(
        fmt::format("{}: {} bytes; at most {} are allowed", path.string(), size, max_bytes));
  }
  auto text = read_if_present(path);
  if (!text) throw InputError(path.string() + ": file not found");
  return *std::move(text);
}

}  // namespace strut
