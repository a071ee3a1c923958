#include "io/sweep_folder.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <system_error>

#include "io/input_error.h"
#include "io/parse_number.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string SweepFolder::name() const {
  const fs::path whole = fs::absolute(root).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::string SweepFolder::shard_name(std::int64_t shard) {
  char name[32];
  std::snprintf(name, sizeof name, "%06lld", static_cast<long long>(shard));
  return name;
}

std::int64_t SweepFolder::parse_shard_name(const std::string& name) {
  const auto shard = parse_number<std::int64_t>(name);
  return shard && name == shard_name(*shard) ? *shard : -1;
}

std::vector<std::int64_t> list_shards(const SweepFolder& folder) {
  std::vector<std::int64_t> shards;
  std::error_code error;
  for (fs::directory_iterator file(folder.shards(), error), end; !error && file != end;
       file.increment(error)) {
    const fs::path& path = file->path();
    const std::int64_t shard = SweepFolder::parse_shard_name(path.stem().string());
    if (shard >= 0 && path == folder.shard(shard)) shards.push_back(shard);
  }
  if (error) throw EnvironmentError(folder.shards().string() + ": " + error.message());
  std::sort(shards.begin(), shards.end());
  return shards;
}

int count_retries(const SweepFolder& folder, std::int64_t shard) {
  int rounds = 0;
  while (fs::exists(folder.retry(shard, rounds))) ++rounds;
  return rounds;
}

Shard read_mended_shard(const SweepFolder& folder, std::int64_t shard,
                        std::vector<RowOrigin>* origins, ShardParts parts) {
  Shard mended = read_shard(folder.shard(shard), parts);
  std::map<std::int64_t, std::size_t> row_of;
  for (std::size_t row = 0; row < mended.rows.size(); ++row) row_of[mended.rows.case_id[row]] = row;
  std::vector<RowOrigin> from(mended.rows.size());
  for (std::size_t row = 0; row < from.size(); ++row) from[row] = {-1, row, from.size()};
  const int rounds = count_retries(folder, shard);
  for (int round = 0; round < rounds; ++round) {
    const fs::path file = folder.retry(shard, round);
    const ShardRows overlay = read_shard(file, parts).rows;
    for (std::size_t row = 0; row < overlay.size(); ++row) {
      const auto found = row_of.find(overlay.case_id[row]);
      if (found == row_of.end()) {
        throw InputError(file.string() + ": case " + std::to_string(overlay.case_id[row]) +
                         " is not in shard " + std::to_string(shard));
      }
      mended.rows.set_row(found->second, overlay, row);
      from[found->second] = {round, row, overlay.size()};
    }
  }
  if (origins != nullptr) *origins = std::move(from);
  return mended;
}

}  // namespace strut
