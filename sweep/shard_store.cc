#include "sweep/shard_store.h"

#include <algorithm>

#include "io/input_error.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

}  // namespace

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
  const Folder source = folder.open(file.parent_path());
  const Folder aside = Folder(folder.root).make_folder(folder.quarantine().filename().string());
  const std::string name = file.filename().string();
  std::string free_name = name;
  for (int copy = 1; !source.move_new(name, aside, free_name); ++copy) {
    free_name = name + "." + std::to_string(copy);
  }
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
