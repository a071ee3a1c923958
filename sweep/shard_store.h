// Checks the shards of a sweep folder against its plan and its journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/store/journal.h"
#include "io/store/shard.h"
#include "sweep/folder.h"

namespace strut {

/// Returns why a shard does not match the plan, judged by its seal alone (512 bytes and the size);
/// empty if it may match.
std::string find_seal_fault(const SweepFolder& folder, const Plan& plan, std::int64_t shard);

/// find_seal_fault of each of these shards.
std::vector<std::string> find_seal_faults(const SweepFolder& folder, const Plan& plan,
                                          const std::vector<std::int64_t>& shards);

/// Moves a file to `quarantine/`, under a free name. Nothing is deleted.
void quarantine(const SweepFolder& folder, const std::filesystem::path& file);

/// A shard with its record, or why it has none.
struct FoundShard {
  std::int64_t shard;
  std::optional<JournalEntry> entry;
  std::string fault;
};

/// The record of each shard: from the journal, or from the file if the journal has none.
class ShardRecords {
 public:
  ShardRecords(const SweepFolder& folder, SweepExtent extent);

  /// The records of existing shards, with the failures that remain after the last retry. A fault is
  /// that a shard's seal or size is wrong or does not match the plan or the journal.
  std::vector<FoundShard> read(const std::vector<std::int64_t>& shards) const;
  /// Returns why a file with this seal, a shard or a retry of it, does not match the plan or the
  /// journal; empty if it matches. A runner that simulates a quarantined shard again and dies
  /// before it writes the journal leaves a different file with the same rows, which matches.
  std::string find_fault(const std::filesystem::path& file, std::int64_t shard,
                         const ShardSeal& seal) const;
  /// The rows of a shard after its retries. Throws InputError if a file is damaged.
  ShardRows read_rows(std::int64_t shard, ShardParts parts = ShardParts::kAll) const;
  bool has_retries(std::int64_t shard) const { return retries_.count(shard) > 0; }
  /// Number of malformed lines, and of entries for work done twice.
  std::size_t bad_lines() const { return journal_.bad_lines; }
  std::int64_t duplicates() const { return duplicates_; }
  const Journal& journal() const { return journal_; }

 private:
  const JournalEntry* find_entry(const std::filesystem::path& file) const;  // null: none
  JournalEntry get(std::int64_t shard, const ShardSeal& seal) const;

  SweepFolder folder_;
  SweepExtent extent_;
  Journal journal_;
  RetryCounts retries_;
  std::map<std::string, std::size_t> last_entries_;  // file -> index of its last entry
  std::int64_t duplicates_ = 0;
};

/// Number of cases of an entry without a result.
std::int64_t count_failures(const JournalEntry& entry);

/// The journal entry of a shard's rows; the caller sets time, seconds and runner.
JournalEntry make_journal_entry(const SweepFolder& folder, const std::filesystem::path& file,
                                const ShardRows& rows);

}  // namespace strut
