// Which cases a sweep consists of, and what of them a shard holds: the guard of all that reads
// shards.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/store/shard.h"

namespace strut {

/// What plan.h5 says of the cases of a sweep, without what they are.
struct SweepExtent {
  std::string plan_hash;
  std::int64_t points = 0;  // that the cases are drawn from: case ids lie in [0, points)
  std::int64_t cases = 0;
  std::int64_t shard_cases = 0;     // of each shard but the last
  std::vector<std::int64_t> drawn;  // case ids, ascending; empty: all points

  std::int64_t shard_count() const;
  std::int64_t shard_size(std::int64_t shard) const;
  bool holds(std::int64_t case_id) const;
  bool operator==(const SweepExtent&) const = default;
};

void write_sweep_extent(Hdf5Writer& plan, const SweepExtent& extent);

/// Throws InputError where an attribute is missing or impossible; `path` stands in messages.
SweepExtent read_sweep_extent(const std::filesystem::path& path, const Hdf5Reader& plan);

/// Throws InputError, with a remedy, unless `file`, sealed with `seal` and holding rows of
/// `case_ids`, can be shard `shard` of the sweep: plan, number, count, and cases of the plan, each
/// once.
void require_shard(const std::filesystem::path& file, const SweepExtent& extent, std::int64_t shard,
                   const ShardSeal& seal, const std::vector<std::int64_t>& case_ids);

/// A case id that appears twice; -1: none.
std::int64_t find_repeated(std::vector<std::int64_t> case_ids);

}  // namespace strut
