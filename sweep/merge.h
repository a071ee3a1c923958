// All shards of a sweep as one file.
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
  bool partial = false;  // go on where shards are missing; without their rows
  std::vector<std::pair<std::string, std::string>> provenance;  // attribute -> text
};

struct MergeReport {
  std::int64_t cases = 0, failed = 0;
  std::int64_t shards = 0, missing = 0;
  std::string data_digest;  // empty: stopped
};

/// Writes the cases of all shards, in the plan's order and as the retries left them, to one file
/// with the datasets and attributes of a shard, sealed. Every byte of every shard is checked on the
/// way. The group /shards tells of each shard that is there its `number`, `first_row`, `rows` and
/// `retries`. Memory: one shard, and 8 bytes a case. `progress` is called with the cases done;
/// where it returns false, nothing is written and the report ends there.
///
/// Throws InputError where a shard is damaged or not the plan's, or missing though `partial` is
/// off.
MergeReport merge_sweep(const SweepFolder& folder, const MergeInput& input,
                        const std::filesystem::path& output, const MergeOptions& options,
                        const std::function<bool(std::int64_t)>& progress);

}  // namespace strut
