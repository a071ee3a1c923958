#include "sweep/shard_store.h"

#include <algorithm>
#include <system_error>

#include "io/input_error.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

}  // namespace

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
                        std::vector<RowOrigin>* origins) {
  Shard mended = read_shard(folder.shard(shard));
  std::map<std::int64_t, std::size_t> row_of;
  for (std::size_t row = 0; row < mended.rows.size(); ++row) row_of[mended.rows.case_id[row]] = row;
  std::vector<RowOrigin> from(mended.rows.size());
  for (std::size_t row = 0; row < from.size(); ++row) from[row] = {-1, row, from.size()};
  const int rounds = count_retries(folder, shard);
  for (int round = 0; round < rounds; ++round) {
    const fs::path file = folder.retry(shard, round);
    const ShardRows overlay = read_shard(file).rows;
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

std::string check_place(const std::string& plan_hash, std::int64_t shard,
                        const std::string& wanted_plan, std::int64_t wanted) {
  if (plan_hash != wanted_plan) return "belongs to another plan";
  if (shard != wanted) return "is shard " + std::to_string(shard) + " of the plan";
  return "";
}

std::string check_seal(const SweepFolder& folder, const Plan& plan, std::int64_t shard) {
  try {
    const ShardSeal seal = read_shard_seal(folder.shard(shard));
    return check_place(seal.plan_hash, seal.shard, plan.hash(), shard);
  } catch (const InputError& e) {
    return e.what();
  }
}

void quarantine(const SweepFolder& folder, const fs::path& file) {
  fs::create_directories(folder.quarantine());
  fs::path place = folder.quarantine() / file.filename();
  for (int copy = 1; fs::exists(place); ++copy) {
    place = folder.quarantine() / (file.filename().string() + "." + std::to_string(copy));
  }
  std::error_code error;
  fs::rename(file, place, error);
  if (error) throw EnvironmentError(file.string() + ": cannot be moved aside: " + error.message());
}

ShardRecords::ShardRecords(const SweepFolder& folder)
    : folder_(folder), journal_(read_journal(folder.journal())) {
  for (std::size_t i = 0; i < journal_.entries.size(); ++i) {
    if (journal_.entries[i].duplicate) {
      ++duplicates_;
    } else {
      lines_[journal_.entries[i].file] = i;
    }
  }
}

JournalEntry ShardRecords::get(std::int64_t shard) {
  JournalEntry entry = get_file(folder_.shard(shard));
  const int rounds = count_retries(folder_, shard);
  if (rounds > 0) {
    const ShardRows rows = read_mended_shard(folder_, shard).rows;
    const JournalEntry mended = make_journal_entry(folder_, folder_.shard(shard), rows);
    entry.failures = mended.failures;
    entry.digest = mended.digest;
  }
  return entry;
}

JournalEntry ShardRecords::get_file(const fs::path& file) {
  const auto line = lines_.find(folder_.name_of(file));
  if (line != lines_.end()) return journal_.entries[line->second];
  JournalEntry entry = make_journal_entry(folder_, file, read_shard(file).rows);
  entry.bytes = fs::file_size(file);
  return entry;
}

std::int64_t count_failures(const JournalEntry& entry) {
  std::int64_t count = 0;
  for (const auto& [reason, cases] : entry.failures) count += cases;
  return count;
}

JournalEntry make_journal_entry(const SweepFolder& folder, const fs::path& file,
                                const ShardRows& rows) {
  JournalEntry entry;
  entry.file = folder.name_of(file);
  entry.cases = static_cast<std::int64_t>(rows.size());
  DataDigest digest;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    digest.add(calc_row_hash(rows, row));
    if (rows.status[row] != 0) ++entry.failures[get_case_status_name(rows.status[row])];
  }
  entry.digest = digest.state();
  return entry;
}

}  // namespace strut
