#include "io/publish.h"

#include "io/file_sync.h"

namespace strut {

namespace fs = std::filesystem;

Published publish(const fs::path& target, std::span<const std::byte> bytes,
                  const fs::path& temporary, const std::string& owner) {
  Published published = Published::kPresent;
  {
    TemporaryFile file(temporary / owner, target);
    file.write(bytes);
    file.flush_and_compare(bytes);
    if (file.name_new()) published = Published::kNew;
  }
  // Also where it was there already: its runner may have died before doing so.
  flush_folder_of(target);
  return published;
}

}  // namespace strut
