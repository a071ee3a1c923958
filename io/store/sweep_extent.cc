#include "io/store/sweep_extent.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/parse_number.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kPointsKey[] = "points", kCasesKey[] = "cases", kShardCasesKey[] = "shard_cases",
               kShardsKey[] = "shards", kDrawnName[] = "/drawn";

/// Parses the cases per shard from the only place where plans of earlier versions hold them: "8;
/// shard s holds positions [s * 512, (s + 1) * ...".
std::int64_t parse_shard_cases(const std::string& words) {
  const std::string before = "[s * ";
  const std::size_t begin = words.find(before);
  if (begin == std::string::npos) return 0;
  const std::size_t first = begin + before.size();
  return parse_number<std::int64_t>(words.substr(first, words.find(',', first) - first))
      .value_or(0);
}

std::string describe_shards(const SweepExtent& extent) {
  return fmt::format("{0}; shard s holds positions [s * {1}, (s + 1) * {1}) of the run order",
                     extent.shard_count(), extent.shard_cases);
}

}  // namespace

std::int64_t SweepExtent::shard_count() const {
  return cases / shard_cases + (cases % shard_cases == 0 ? 0 : 1);
}

std::int64_t SweepExtent::shard_size(std::int64_t shard) const {
  return std::min(shard_cases, cases - shard * shard_cases);
}

bool SweepExtent::holds(std::int64_t case_id) const {
  if (drawn.empty()) return case_id >= 0 && case_id < points;
  return std::binary_search(drawn.begin(), drawn.end(), case_id);
}

void write_sweep_extent(Hdf5Writer& plan, const SweepExtent& extent) {
  plan.write_attribute("/", kPlanHashKey, extent.plan_hash);
  plan.write_attribute("/", kPointsKey, extent.points);
  plan.write_attribute("/", kCasesKey, extent.cases);
  plan.write_attribute("/", kShardCasesKey, extent.shard_cases);
  plan.write_attribute("/", kShardsKey, describe_shards(extent));
  if (!extent.drawn.empty()) {
    plan.write(kDrawnName, std::span<const std::int64_t>(extent.drawn),
               {"1", "case ids that run, ascending", {}});
  }
}

SweepExtent read_sweep_extent(const fs::path& path, const Hdf5Reader& plan) {
  SweepExtent extent;
  extent.plan_hash = plan.read_attribute("/", kPlanHashKey);
  extent.points = plan.read_integer_attribute("/", kPointsKey);
  extent.cases = plan.read_integer_attribute("/", kCasesKey);
  extent.shard_cases = plan.has_attribute("/", kShardCasesKey)
                           ? plan.read_integer_attribute("/", kShardCasesKey)
                           : parse_shard_cases(plan.read_attribute("/", kShardsKey));
  if (plan.has(kDrawnName)) extent.drawn = plan.read_integers(kDrawnName);
  const auto drawn = static_cast<std::int64_t>(extent.drawn.size());
  const bool good = extent.cases > 0 && extent.shard_cases > 0 && extent.points >= extent.cases &&
                    (drawn == 0 ? extent.cases == extent.points : extent.cases == drawn) &&
                    std::is_sorted(extent.drawn.begin(), extent.drawn.end());
  if (!good) {
    throw InputError(fmt::format("{}: damaged: points, cases and shards are inconsistent; {}",
                                 path.string(), kPlanSeal.remedy));
  }
  return extent;
}

namespace {

/// Returns the reason why the file cannot be the shard; "" if it can.
std::string find_fault(const SweepExtent& extent, std::int64_t shard, const ShardSeal& seal,
                       const std::vector<std::int64_t>& case_ids) {
  std::string misplacement = find_misplacement(seal, extent.plan_hash, shard);
  if (!misplacement.empty()) return misplacement;
  if (shard >= extent.shard_count()) return fmt::format("the plan has no shard {}", shard);
  const auto count = static_cast<std::int64_t>(case_ids.size());
  if (count != extent.shard_size(shard)) {
    return fmt::format("has {} cases; the plan has {} in this shard", count,
                       extent.shard_size(shard));
  }
  const auto foreign = std::find_if_not(case_ids.begin(), case_ids.end(),
                                        [&](std::int64_t id) { return extent.holds(id); });
  if (foreign != case_ids.end()) return fmt::format("case {} is not in the plan", *foreign);
  return describe_repeated(case_ids);
}

}  // namespace

void require_shard(const fs::path& file, const SweepExtent& extent, std::int64_t shard,
                   const ShardSeal& seal, const std::vector<std::int64_t>& case_ids) {
  const std::string fault = find_fault(extent, shard, seal, case_ids);
  if (fault.empty()) return;
  throw InputError(fmt::format("{}: {}; {}", file.string(), fault, kShardSeal.remedy));
}

std::int64_t find_repeated(std::vector<std::int64_t> case_ids) {
  std::sort(case_ids.begin(), case_ids.end());
  const auto repeated = std::adjacent_find(case_ids.begin(), case_ids.end());
  return repeated == case_ids.end() ? -1 : *repeated;
}

std::string describe_repeated(const std::vector<std::int64_t>& case_ids) {
  const std::int64_t repeated = find_repeated(case_ids);
  return repeated < 0 ? "" : fmt::format("holds case {} twice", repeated);
}

}  // namespace strut
