// The cases of a sweep and their division into shards; everything that reads shards checks them
// against it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/store/shard.h"

namespace strut {

/// Numbers of the cases of a sweep, from plan.h5.
struct SweepExtent {
  std::string plan_hash;
  std::int64_t points = 0;  // case ids are drawn from [0, points)
  std::int64_t cases = 0;
  std::int64_t shard_cases = 0;     // per shard; the last may have fewer
  std::vector<std::int64_t> drawn;  // case ids, ascending; empty: all points

  std::int64_t shard_count() const;
  std::int64_t shard_size(std::int64_t shard) const;
  bool holds(std::int64_t case_id) const;
  bool operator==(const SweepExtent&) const = default;
};

void write_sweep_extent(Hdf5Writer& plan, const SweepExtent& extent);

/// Reads the extent from a plan that messages call `path`. Throws InputError if an attribute is
/// missing or inconsistent.
SweepExtent read_sweep_extent(const std::filesystem::path& path, const Hdf5Reader& plan);

/// Throws InputError, with a remedy, unless `file`, with the seal `seal` and rows of `case_ids`,
/// can be shard `shard` of the sweep: plan, number and count match, and all cases are the plan's,
/// each once.
void require_shard(const std::filesystem::path& file, const SweepExtent& extent, std::int64_t shard,
                   const ShardSeal& seal, const std::vector<std::int64_t>& case_ids);

/// Returns a case id that appears twice; -1 if there is none.
std::int64_t find_repeated(std::vector<std::int64_t> case_ids);
/// Returns the fault "holds case N twice", or "" if no case id appears twice.
std::string describe_repeated(const std::vector<std::int64_t>& case_ids);

}  // namespace strut
