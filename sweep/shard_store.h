// The shards of a sweep folder against its plan and its journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/store/journal.h"
#include "io/store/shard.h"
#include "sweep/folder.h"

namespace strut {

/// Why a shard cannot be what the plan asks for, by its seal alone (512 bytes and the size); empty
/// where nothing speaks against it.
std::string find_seal_fault(const SweepFolder& folder, const Plan& plan, std::int64_t shard);

/// Moves a file aside, into `quarantine/`, under a name that is free there. Nothing is deleted.
void quarantine(const SweepFolder& folder, const std::filesystem::path& file);

/// The record of each shard: the journal's, or the file's own where the journal has none.
class ShardRecords {
 public:
  ShardRecords(const SweepFolder& folder, SweepExtent extent);

  /// The record of a shard that exists; failures as the last retry left them. Throws InputError
  /// where its seal or size is wrong, or not the plan's or the journal's.
  JournalEntry get(std::int64_t shard) const;
  /// Why a file with this seal, a shard or a retry of it, is not the plan's or not what the journal
  /// says was published; empty where it is. A shard that was moved aside and made again by a runner
  /// that died before it could say so is another file with the same rows.
  std::string find_fault(const std::filesystem::path& file, std::int64_t shard,
                         const ShardSeal& seal) const;
  /// Lines that were no lines; entries of work done twice.
  std::size_t bad_lines() const { return journal_.bad_lines; }
  std::int64_t duplicates() const { return duplicates_; }
  const Journal& journal() const { return journal_; }

 private:
  const JournalEntry* find_line(const std::filesystem::path& file) const;  // null: none

  SweepFolder folder_;
  SweepExtent extent_;
  Journal journal_;
  std::map<std::string, std::size_t> lines_;  // file -> its last entry
  std::int64_t duplicates_ = 0;
};

/// Cases of an entry that have no result.
std::int64_t count_failures(const JournalEntry& entry);

/// The journal's line of a shard's rows; time, seconds and runner are left to the caller.
JournalEntry make_journal_entry(const SweepFolder& folder, const std::filesystem::path& file,
                                const ShardRows& rows);

}  // namespace strut
