// Merges the shards of a sweep into one file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/store/shard.h"
#include "sweep/folder.h"

namespace strut {

/// The part of a plan that a merge needs.
struct MergeInput {
  SweepExtent extent;
  ShardSchema schema;
};

struct MergeOptions {
  bool partial = false;  // merge what there is if shards are missing
  std::vector<std::pair<std::string, std::string>> provenance;  // attribute -> text
};

struct MergeReport {
  std::int64_t cases = 0, failed = 0;
  std::int64_t shards = 0, missing = 0;
  std::string data_digest;  // empty: stopped by `progress`
};

/// Writes the cases of all shards, in the plan's order and as the last retry left them, to one
/// sealed file with the datasets and attributes of a shard. Checks every byte of every shard. The
/// group /shards lists `number`, `first_row`, `rows` and `retries` of each merged shard. Memory:
/// one shard and 8 bytes per case. `progress` is called with the number of cases done; if it
/// returns false, nothing is written and the report ends there.
///
/// Throws InputError if a shard is damaged, not of this plan, or missing while `partial` is off.
MergeReport merge_sweep(const SweepFolder& folder, const MergeInput& input,
                        const std::filesystem::path& output, const MergeOptions& options,
                        const std::function<bool(std::int64_t)>& progress);

}  // namespace strut
