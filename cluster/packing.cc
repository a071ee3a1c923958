#include "cluster/packing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace strut {
namespace {

/// A sweep with holes everywhere is not worth a job each.
constexpr std::size_t kMostRanges = 16;

/// Closes the narrowest gaps until at most so many ranges are left, fewer where gaps are alike.
void close_gaps(std::vector<ShardRange>& ranges, std::size_t most) {
  if (ranges.size() <= most) return;
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    gaps.push_back(ranges[i].first - ranges[i - 1].end);
  }
  auto cut = gaps.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(gaps.begin(), cut, gaps.end(), std::greater<>());
  const std::int64_t narrow = *cut;
  std::vector<ShardRange> wide = {ranges.front()};
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].first - wide.back().end > narrow) {
      wide.push_back(ranges[i]);
    } else {
      wide.back().end = ranges[i].end;
    }
  }
  ranges = std::move(wide);
}

std::int64_t count_tasks(const std::vector<ShardRange>& ranges, std::int64_t shards_a_task) {
  std::int64_t tasks = 0;
  for (const ShardRange& range : ranges) tasks += PackedArray{range, shards_a_task}.tasks();
  return tasks;
}

}  // namespace

std::vector<ShardRange> list_missing(std::int64_t shards, const std::vector<std::int64_t>& present,
                                     std::vector<ShardRange> taken) {
  for (const std::int64_t shard : present) taken.push_back({shard, shard + 1});
  std::sort(taken.begin(), taken.end(),
            [](const ShardRange& a, const ShardRange& b) { return a.first < b.first; });
  std::vector<ShardRange> missing;
  std::int64_t next = 0;
  for (const ShardRange& range : taken) {
    if (range.first > next) missing.push_back({next, std::min(range.first, shards)});
    next = std::max(next, range.end);
    if (next >= shards) break;
  }
  if (next < shards) missing.push_back({next, shards});
  return missing;
}

ShardRange PackedArray::get_task(std::int64_t task) const {
  const std::int64_t first = shards.first + task * shards_a_task;
  return {first, std::min(first + shards_a_task, shards.end)};
}

std::vector<PackedArray> pack_shards(std::vector<ShardRange> missing,
                                     const PackingRequest& request) {
  close_gaps(missing, std::min(kMostRanges, static_cast<std::size_t>(request.limits.tasks)));
  const double fit = std::floor(request.task_seconds / request.shard_seconds);
  std::int64_t shards_a_task = std::max<std::int64_t>(1, std::llround(std::min(fit, 1e15)));
  std::int64_t total = 0;
  for (const ShardRange& range : missing) total += range.count();
  shards_a_task = std::min(shards_a_task, std::max<std::int64_t>(total, 1));
  while (count_tasks(missing, shards_a_task) > request.limits.tasks && shards_a_task < total) {
    shards_a_task = std::min(total, std::max(shards_a_task + 1, shards_a_task * 5 / 4));
  }
  std::vector<PackedArray> arrays;
  const std::int64_t most = std::min(request.limits.array_tasks, total) * shards_a_task;
  for (const ShardRange& range : missing) {
    for (std::int64_t first = range.first; first < range.end; first += most) {
      arrays.push_back({{first, std::min(range.end, first + most)}, shards_a_task});
    }
  }
  return arrays;
}

}  // namespace strut
