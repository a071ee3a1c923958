// The files of a sweep folder: their names, and shards with their retries applied.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/file/folder.h"
#include "io/store/shard.h"
#include "io/store/sweep_extent.h"

namespace strut {

struct SweepFolder {
  std::filesystem::path root;

  std::filesystem::path request() const { return root / "request.toml"; }
  std::filesystem::path inputs() const { return root / "request"; }  // copies of the input files
  std::filesystem::path plan() const { return root / "plan.h5"; }
  std::filesystem::path journal() const { return root / "journal"; }
  std::filesystem::path shards() const { return root / "shards"; }
  std::filesystem::path retries() const { return root / "retries"; }
  std::filesystem::path claims() const { return root / "claims"; }
  std::filesystem::path temporary() const { return root / "tmp"; }
  std::filesystem::path quarantine() const { return root / "quarantine"; }
  std::filesystem::path logs() const { return root / "logs"; }

  /// Opens `subfolder`, one of the above, for writing. Throws InputError if it is missing or a
  /// link.
  Folder open(const std::filesystem::path& subfolder) const {
    return Folder(root).open_folder(subfolder.filename().string());
  }

  /// Returns the name of the folder itself: "cars" for "cars/", "../cars" and, within it, ".".
  std::string name() const;

  /// Returns "000042", the name of the file and of the claim on it.
  static std::string shard_name(std::int64_t shard);
  /// Returns the number in such a name; -1 for any other text.
  static std::int64_t parse_shard_name(const std::string& name);
  /// Returns the name of the claim on the next retry of a shard.
  static std::string retry_unit(std::int64_t shard) { return kRetryPrefix + shard_name(shard); }
  static bool is_retry_unit(const std::string& unit) { return unit.starts_with(kRetryPrefix); }

  /// Returns "shards/000042.h5", the name of a file in the journal and in messages.
  std::string name_of(const std::filesystem::path& file) const {
    return file.lexically_relative(root).generic_string();
  }
  std::filesystem::path shard(std::int64_t number) const {
    return shards() / (shard_name(number) + ".h5");
  }
  /// Returns the file of the `round`-th retry of a shard.
  std::filesystem::path retry(std::int64_t number, int round) const;

 private:
  static constexpr const char* kRetryPrefix = "retry-";
};

/// Returns the numbers of the shards in `shards/`, ascending, by name alone. Throws
/// EnvironmentError.
std::vector<std::int64_t> list_shards(const SweepFolder& folder);

/// Returns the number of rounds of retries in `retries/` for a shard: 0, 1, ... without a gap.
int count_retries(const SweepFolder& folder, std::int64_t shard);

/// Number of rounds of retries of each shard that has any. Shards without cost nothing.
using RetryCounts = std::map<std::int64_t, int>;
/// Throws EnvironmentError.
RetryCounts count_all_retries(const SweepFolder& folder);

/// Reads the extent from plan.h5. Throws InputError if it is missing or damaged.
SweepExtent read_sweep_extent(const SweepFolder& folder);

/// Replaces rows of a shard by those of its retries. Throws InputError if a retry is damaged or
/// belongs to another shard.
void apply_retries(const SweepFolder& folder, Shard& shard, ShardParts parts = ShardParts::kAll);

/// Reads a shard and applies its retries. Throws InputError if a file is damaged or does not belong
/// to the plan (require_shard), or if a retry belongs to another shard.
Shard read_shard_with_retries(const SweepFolder& folder, const SweepExtent& extent,
                              std::int64_t shard, ShardParts parts = ShardParts::kAll);

}  // namespace strut
