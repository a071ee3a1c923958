#include "io/file/publish.h"

#include "io/file/temporary_file.h"

namespace strut {

Published publish(const Folder& folder, const std::string& name, std::span<const std::byte> bytes,
                  const Folder& temporary, const std::string& owner) {
  Published published = Published::kPresent;
  {
    TemporaryFile file(temporary, owner, folder, name);
    file.write(bytes);
    file.flush_and_compare(bytes);
    if (file.name_new()) published = Published::kNew;
  }
  // Also if another runner's file has the name: that runner may have died before flushing.
  folder.flush(folder.path_of(name));
  return published;
}

}  // namespace strut
