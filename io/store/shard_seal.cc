// The seal of a shard: its plan and its number.
#include <fmt/format.h>

#include "base/text/parse_number.h"
#include "io/store/shard.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kPlanLine[] = "plan", kShardLine[] = "shard";

}  // namespace

SealLabel make_shard_label(const std::string& plan_hash, std::int64_t shard) {
  return {kShardSeal, {{kPlanLine, plan_hash}, {kShardLine, std::to_string(shard)}}};
}

ShardSeal make_shard_seal(const FileSeal& seal) {
  const auto shard = parse_number<std::int64_t>(seal.get(kShardLine));
  return {seal.get(kPlanLine), shard.value_or(-1), seal.size, seal.sha256};
}

ShardSeal read_shard_seal(const fs::path& path) {
  return make_shard_seal(require_intact(path, check_seal(path, kShardSeal)));
}

ShardSeal read_shard_seal(const fs::path& path, std::span<const std::byte> bytes) {
  return make_shard_seal(require_intact(path, check_seal(bytes, bytes.size(), kShardSeal)));
}

ShardSeal check_shard_bytes(const fs::path& path) {
  return make_shard_seal(require_intact(path, check_sealed_file(path, kShardSeal)));
}

ShardSeal check_shard_bytes(const fs::path& path, std::span<const std::byte> bytes) {
  return make_shard_seal(require_intact(path, check_sealed_bytes(bytes, kShardSeal)));
}

std::string find_misplacement(const ShardSeal& seal, const std::string& plan_hash,
                              std::int64_t shard) {
  if (seal.plan_hash != plan_hash) return "belongs to another plan";
  if (seal.shard != shard) return fmt::format("is shard {} of the plan", seal.shard);
  return "";
}

}  // namespace strut
