#include "io/store/sweep_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "base/error/input_error.h"
#include "base/text/parse_number.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

ShardSeal get_seal(const Shard& shard) {
  return {.plan_hash = shard.provenance.plan_hash, .shard = shard.provenance.shard, .sha256 = {}};
}

InputError retry_error(const fs::path& file, const std::string& fault) {
  return InputError(fmt::format("{}: {}; {}", file.string(), fault, kShardSeal.remedy));
}

/// Throws InputError unless `overlay` can be a retry of some cases of `shard`.
void require_retry(const fs::path& file, const Shard& shard, const Shard& overlay) {
  std::string fault =
      find_misplacement(get_seal(overlay), shard.provenance.plan_hash, shard.provenance.shard);
  if (fault.empty() && overlay.schema != shard.schema) {
    fault = "its columns differ from those of its shard";
  }
  if (fault.empty()) fault = describe_repeated(overlay.rows.case_id);
  if (!fault.empty()) throw retry_error(file, fault);
}

/// Calls `act(path)` for each file of a folder. Throws EnvironmentError where it cannot be listed.
template <class Act>
void for_each_file(const fs::path& folder, const Act& act) {
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    act(file->path());
  }
  if (error) throw file_failure(folder, "cannot be listed", error.value());
}

}  // namespace

std::string SweepFolder::name() const {
  const fs::path whole = fs::absolute(root).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::string SweepFolder::shard_name(std::int64_t shard) { return fmt::format("{:06}", shard); }

fs::path SweepFolder::retry(std::int64_t number, int round) const {
  return retries() / fmt::format("{}.{}.h5", shard_name(number), round);
}

std::int64_t SweepFolder::parse_shard_name(const std::string& name) {
  const auto shard = parse_number<std::int64_t>(name);
  return shard && name == shard_name(*shard) ? *shard : -1;
}

std::vector<std::int64_t> list_shards(const SweepFolder& folder) {
  std::vector<std::int64_t> shards;
  for_each_file(folder.shards(), [&](const fs::path& path) {
    const std::int64_t shard = SweepFolder::parse_shard_name(path.stem().string());
    if (shard >= 0 && path == folder.shard(shard)) shards.push_back(shard);
  });
  std::sort(shards.begin(), shards.end());
  return shards;
}

int count_retries(const SweepFolder& folder, std::int64_t shard) {
  int rounds = 0;
  while (fs::exists(folder.retry(shard, rounds))) ++rounds;
  return rounds;
}

RetryCounts count_all_retries(const SweepFolder& folder) {
  RetryCounts counts;
  std::error_code ignored;
  if (!fs::exists(folder.retries(), ignored)) return counts;
  for_each_file(folder.retries(), [&](const fs::path& path) {
    const std::int64_t shard = SweepFolder::parse_shard_name(path.stem().stem().string());
    if (shard >= 0 && path == folder.retry(shard, 0)) counts[shard] = 1;
  });
  for (auto& [shard, count] : counts) count = count_retries(folder, shard);
  return counts;
}

SweepExtent read_sweep_extent(const SweepFolder& folder) {
  const Hdf5Reader plan(folder.plan(), kPlanSeal);
  return read_sweep_extent(folder.plan(), plan);
}

void apply_retries(const SweepFolder& folder, Shard& shard, ShardParts parts) {
  ShardRows& rows = shard.rows;
  const std::int64_t number = shard.provenance.shard;
  std::map<std::int64_t, std::size_t> row_of;
  for (std::size_t row = 0; row < rows.size(); ++row) row_of[rows.case_id[row]] = row;
  const int rounds = count_retries(folder, number);
  for (int round = 0; round < rounds; ++round) {
    const fs::path file = folder.retry(number, round);
    const Shard overlay = read_shard(file, parts);
    require_retry(file, shard, overlay);
    for (std::size_t row = 0; row < overlay.rows.size(); ++row) {
      const auto found = row_of.find(overlay.rows.case_id[row]);
      if (found == row_of.end()) {
        throw retry_error(
            file, fmt::format("case {} is not in shard {}", overlay.rows.case_id[row], number));
      }
      rows.set_row(found->second, overlay.rows, row);
    }
  }
}

Shard read_shard_with_retries(const SweepFolder& folder, const SweepExtent& extent,
                              std::int64_t shard, ShardParts parts) {
  Shard read = read_shard(folder.shard(shard), parts);
  require_shard(folder.shard(shard), extent, shard, get_seal(read), read.rows.case_id);
  apply_retries(folder, read, parts);
  return read;
}

}  // namespace strut
