#include "sweep/clean_up.h"

#include <string>

#include "io/file/atomic_file.h"

namespace strut {
namespace {

/// The runner that owns a file OWNER.NUMBER in tmp/; empty if no runner uses such a name.
std::string parse_owner(const std::string& file) {
  const auto dot = file.rfind('.');
  const bool is_numbered = dot != std::string::npos && dot + 1 < file.size() &&
                           file.find_first_not_of("0123456789", dot + 1) == std::string::npos;
  const std::string owner = is_numbered ? file.substr(0, dot) : "";
  return Claims::is_runner_name(owner) ? owner : "";
}

/// True if no runner would request a claim on `unit` again.
bool is_finished(const SweepFolder& folder, const std::string& unit) {
  const std::int64_t shard = SweepFolder::parse_shard_name(unit);
  return shard >= 0 ? std::filesystem::exists(folder.shard(shard))
                    : SweepFolder::is_retry_unit(unit);
}

}  // namespace

void clean_up(const SweepFolder& folder, Claims& claims) {
  const Folder temporary = folder.open(folder.temporary());
  for (const std::string& file : temporary.list()) {
    const std::string owner = parse_owner(file);
    const bool is_dead = !owner.empty() && owner != claims.runner() && !claims.may_be_alive(owner);
    if (is_dead) temporary.try_remove(file);
  }
  for (const std::string& unit : folder.open(folder.claims()).list()) {
    if (!is_finished(folder, unit)) continue;
    if (claims.claim(unit) == Claims::Answer::kMine) claims.release(unit);
  }
  remove_abandoned_files(Folder(folder.root));
}

}  // namespace strut
