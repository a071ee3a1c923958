#include "jobs/cli/unsealed.h"

#include <fmt/format.h>

#include <set>

#include "io/store/sweep_folder.h"
#include "jobs/cli/messages.h"

namespace strut {

namespace fs = std::filesystem;

void note_unsealed(const fs::path& file, const SealKind& kind) {
  static std::set<fs::path> noted;
  if (is_sealed(file) || !noted.insert(file).second) return;
  print_note(fmt::format(
      "{}: has no seal, as written by an earlier version, so not all damage can be detected; {}",
      file.string(), kind.sealing));
}

void note_unsealed_data(const std::vector<std::string>& paths) {
  for (const fs::path path : paths) {
    if (fs::is_directory(path)) {
      note_unsealed(SweepFolder{path}.plan(), kPlanSeal);
    } else {
      note_unsealed(path, kMergedSeal);
    }
  }
}

TrainedModel load_model(const fs::path& file) {
  TrainedModel model = read_trained_model(file);
  note_unsealed(file, kModelSeal);
  return model;
}

}  // namespace strut
