#include "model_files/file_kind.h"

#include <fmt/format.h>

namespace strut {
namespace {

constexpr const FileKind* kFileKinds[] = {&kModelFile, &kManeuverFile, &kRigManeuverFile,
                                          &kSweepFile, &kCampaignFile, &kStudyFile};

}  // namespace

Table open_root(const Document& document, const FileKind& kind) {
  Table root = document.root();
  if (root.has(kind.key)) return root;
  for (const FileKind* other : kFileKinds) {
    if (!root.has(other->key)) continue;
    throw InputError(
        fmt::format("{}: a {}; must be a {}", document.path().string(), other->name, kind.name));
  }
  return root;
}

}  // namespace strut
