#include "io/file/read_text_file.h"

#include <system_error>
#include <utility>

#include "io/file/file_sync.h"

namespace strut {

namespace fs = std::filesystem;

std::string read_text_file(const fs::path& path, std::size_t max_bytes) {
  std::error_code error;  // reading tells it
  if (const auto size = fs::file_size(path, error); !error && size > max_bytes) {
    throw InputError(path.string() + ": " + std::to_string(size) + " bytes; at most " +
                     std::to_string(max_bytes) + " are allowed");
  }
  auto text = read_if_present(path);
  if (!text) throw InputError(path.string() + ": file not found");
  return *std::move(text);
}

}  // namespace strut
