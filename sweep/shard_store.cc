#include "sweep/shard_store.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Calls `work(i)` for i = 0 .. count - 1, each of which reads one file, on several threads: a file
/// system on a network answers late, but many at once.
template <class Work>
void share_files(std::size_t count, const Work& work) {
  constexpr std::size_t kFew = 256;  // below it the threads take longer to start than to read
  constexpr int kThreads = 16;       // files that are waited for at once
  const auto read = [&](std::size_t i, int /*thread*/) { work(i); };
  try {
    share_items(count < kFew ? 1 : kThreads, count, read);
  } catch (const std::system_error&) {  // so many threads are not allowed here
    share_items(1, count, read);
  }
}

constexpr char kOtherData[] = "does not hold the data published under this name";

}  // namespace

std::string find_seal_fault(const SweepFolder& folder, const Plan& plan, std::int64_t shard) {
  try {
    const SealCheck check = check_seal(folder.shard(shard), kShardSeal);
    if (!check.fault.empty()) return check.fault;
    return find_misplacement(make_shard_seal(check.seal), plan.hash(), shard);
  } catch (const InputError& e) {
    return e.what();
  }
}

std::vector<std::string> find_seal_faults(const SweepFolder& folder, const Plan& plan,
                                          const std::vector<std::int64_t>& shards) {
  std::vector<std::string> faults(shards.size());
  share_files(shards.size(),
              [&](std::size_t i) { faults[i] = find_seal_fault(folder, plan, shards[i]); });
  return faults;
}

void quarantine(const SweepFolder& folder, const fs::path& file) {
  const Folder source = folder.open(file.parent_path());
  const Folder aside = Folder(folder.root).make_folder(folder.quarantine().filename().string());
  const std::string name = file.filename().string();
  std::string free_name = name;
  for (int copy = 1; !source.move_new(name, aside, free_name); ++copy) {
    free_name = name + "." + std::to_string(copy);
  }
}

ShardRecords::ShardRecords(const SweepFolder& folder, SweepExtent extent)
    : folder_(folder),
      extent_(std::move(extent)),
      journal_(read_journal(folder.journal())),
      retries_(count_all_retries(folder)) {
  for (std::size_t i = 0; i < journal_.entries.size(); ++i) {
    if (journal_.entries[i].duplicate) {
      ++duplicates_;
    } else {
      last_entries_[journal_.entries[i].file] = i;
    }
  }
}

const JournalEntry* ShardRecords::find_entry(const fs::path& file) const {
  const auto last = last_entries_.find(folder_.name_of(file));
  return last == last_entries_.end() ? nullptr : &journal_.entries[last->second];
}

std::string ShardRecords::find_fault(const fs::path& file, std::int64_t shard,
                                     const ShardSeal& seal) const {
  std::string fault = find_misplacement(seal, extent_.plan_hash, shard);
  if (!fault.empty()) return fault;
  const JournalEntry* const published = find_entry(file);
  const bool is_as_published = published == nullptr || published->sha256 == seal.sha256 ||
                               published->digest == calc_rows_digest(read_shard(file).rows).state();
  return is_as_published ? "" : kOtherData;
}

std::vector<FoundShard> ShardRecords::read(const std::vector<std::int64_t>& shards) const {
  std::vector<FoundShard> found(shards.size());
  std::vector<ShardSeal> seals(shards.size());
  share_files(shards.size(), [&](std::size_t i) {
    found[i].shard = shards[i];
    try {
      seals[i] = read_shard_seal(folder_.shard(shards[i]));
    } catch (const InputError& e) {
      found[i].fault = e.what();
    }
  });
  // One after the other: HDF5 reads the shards with retries.
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (!found[i].fault.empty()) continue;
    try {
      found[i].entry = get(shards[i], seals[i]);
    } catch (const InputError& e) {
      found[i].fault = e.what();
    }
  }
  return found;
}

JournalEntry ShardRecords::get(std::int64_t shard, const ShardSeal& seal) const {
  const fs::path file = folder_.shard(shard);
  const std::string fault = find_fault(file, shard, seal);
  if (!fault.empty()) {
    throw InputError(fmt::format("{}: {}; {}", file.string(), fault, kShardSeal.remedy));
  }
  const JournalEntry* const published = find_entry(file);
  if (published != nullptr && !has_retries(shard)) return *published;
  const JournalEntry mended = make_journal_entry(folder_, file, read_rows(shard));
  JournalEntry entry = published == nullptr ? mended : *published;
  entry.bytes = seal.size;
  entry.failures = mended.failures;
  entry.digest = mended.digest;
  return entry;
}

ShardRows ShardRecords::read_rows(std::int64_t shard, ShardParts parts) const {
  return read_shard_with_retries(folder_, extent_, shard, parts).rows;
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
    if (rows.status[row] != 0) ++entry.failures[get_run_status_name(rows.status[row])];
  }
  entry.digest = digest.state();
  return entry;
}

}  // namespace strut
