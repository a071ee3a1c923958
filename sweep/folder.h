// The sweep folder: names, making one, opening one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sweep/plan.h"

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

/// Makes the subfolders that are not there: a copy may have lost the empty ones. Throws
/// EnvironmentError.
void make_subfolders(const SweepFolder& folder);

/// Makes the folder of a plan: request.toml with copies of every file it names, plan.h5, the empty
/// subfolders; plan.h5 last, so a folder is planned or it is not. Planning the same request again
/// changes nothing. Throws InputError where `root` holds another plan (it lists what changed) or is
/// no folder of ours, EnvironmentError where it cannot be written.
SweepFolder make_sweep_folder(const std::filesystem::path& root, const Plan& plan);

/// Opens a planned folder. Throws InputError where it is none, or its request was edited since (it
/// lists what changed).
Plan open_sweep_folder(const SweepFolder& folder);

}  // namespace strut
