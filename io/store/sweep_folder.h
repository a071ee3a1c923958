// The files of a sweep folder: their names, and the shards as retries left them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/file/folder.h"
#include "io/store/shard.h"
#include "io/store/sweep_extent.h"

namespace strut {

struct SweepFolder {
  std::filesystem::path root;

  std::filesystem::path request() const { return root / "request.toml"; }
  std::filesystem::path inputs() const { return root / "request"; }  // copies of the named files
  std::filesystem::path plan() const { return root / "plan.h5"; }
  std::filesystem::path journal() const { return root / "journal"; }
  std::filesystem::path shards() const { return root / "shards"; }
  std::filesystem::path retries() const { return root / "retries"; }
  std::filesystem::path claims() const { return root / "claims"; }
  std::filesystem::path temporary() const { return root / "tmp"; }
  std::filesystem::path quarantine() const { return root / "quarantine"; }
  std::filesystem::path logs() const { return root / "logs"; }

  /// `subfolder`, one of the above, for writing. Throws InputError where it is missing or a link.
  Folder open(const std::filesystem::path& subfolder) const {
    return Folder(root).open_folder(subfolder.filename().string());
  }

  /// The folder's own: "cars" of "cars/", of "../cars" and, within it, of ".".
  std::string name() const;

  /// "000042": of the file, and of the claim on it.
  static std::string shard_name(std::int64_t shard);
  /// The number of such a name; -1 for any other text.
  static std::int64_t parse_shard_name(const std::string& name);
  /// The claim on the next retry of a shard.
  static std::string retry_unit(std::int64_t shard) { return kRetryPrefix + shard_name(shard); }
  static bool is_retry_unit(const std::string& unit) { return unit.rfind(kRetryPrefix, 0) == 0; }

  /// "shards/000042.h5": how journal and messages call a file of the folder.
  std::string name_of(const std::filesystem::path& file) const {
    return file.lexically_relative(root).generic_string();
  }
  std::filesystem::path shard(std::int64_t number) const {
    return shards() / (shard_name(number) + ".h5");
  }
  /// The overlay that the `round`-th retry of a shard wrote.
  std::filesystem::path retry(std::int64_t number, int round) const {
    return retries() / (shard_name(number) + "." + std::to_string(round) + ".h5");
  }

 private:
  static constexpr const char* kRetryPrefix = "retry-";
};

/// Numbers of the shards that `shards/` holds, ascending, by name alone.
std::vector<std::int64_t> list_shards(const SweepFolder& folder);

/// Rounds of retries that `retries/` holds for a shard: 0, 1, ... without a gap.
int count_retries(const SweepFolder& folder, std::int64_t shard);

/// What plan.h5 says. Throws InputError where it is missing or damaged.
SweepExtent read_sweep_extent(const SweepFolder& folder);

/// Replaces the rows of a shard by those of its retries. Throws InputError where one is damaged or
/// not of this shard.
void apply_retries(const SweepFolder& folder, Shard& shard, ShardParts parts = ShardParts::kAll);

/// A shard with its rows as the retries left them. Throws InputError where a file is damaged, or
/// not the plan's (require_shard), or a retry is not of this shard.
Shard read_mended_shard(const SweepFolder& folder, const SweepExtent& extent, std::int64_t shard,
                        ShardParts parts = ShardParts::kAll);

}  // namespace strut
