#include "report/content.h"

#include <algorithm>
#include <iterator>

namespace strut {

const FolderContent* find_content(const std::filesystem::path& folder) {
  const auto* found = std::find_if(
      std::begin(kFolderContents), std::end(kFolderContents),
      [&](const FolderContent* c) { return std::filesystem::exists(folder / c->file); });
  return found == std::end(kFolderContents) ? nullptr : *found;
}

}  // namespace strut
