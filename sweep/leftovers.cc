#include "sweep/leftovers.h"

#include <string>
#include <system_error>
#include <vector>

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Listed first: removing and claiming change the folder.
std::vector<fs::path> list_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    files.push_back(file->path());
  }
  return files;
}

bool is_over(const SweepFolder& folder, const std::string& unit) {
  const std::int64_t shard = SweepFolder::parse_shard_name(unit);
  return shard >= 0 ? fs::exists(folder.shard(shard)) : SweepFolder::is_retry_unit(unit);
}

}  // namespace

void remove_leftovers(const SweepFolder& folder, Claims& claims) {
  for (const fs::path& file : list_files(folder.temporary())) {
    const std::string owner = file.stem().string();
    std::error_code gone;
    if (owner != claims.runner() && !claims.may_live(owner)) fs::remove(file, gone);
  }
  for (const fs::path& file : list_files(folder.claims())) {
    const std::string unit = file.filename().string();
    if (!is_over(folder, unit)) continue;
    if (claims.claim(unit) == Claims::Answer::kMine) claims.release(unit);
  }
}

}  // namespace strut
