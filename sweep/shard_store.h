// The shards of a sweep folder against its plan and its journal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/journal.h"
#include "io/shard.h"
#include "sweep/folder.h"

namespace strut {

/// Why a file that says to be shard `shard` of the plan with this hash cannot be the `wanted` shard
/// of the `wanted_plan`; empty where it can.
std::string check_place(const std::string& plan_hash, std::int64_t shard,
                        const std::string& wanted_plan, std::int64_t wanted);

/// Why a shard cannot be what the plan asks for, by its seal alone (512 bytes and the size); empty
/// where nothing speaks against it.
std::string check_seal(const SweepFolder& folder, const Plan& plan, std::int64_t shard);

/// Moves a file aside, into `quarantine/`, under a name that is free there. Nothing is deleted.
void quarantine(const SweepFolder& folder, const std::filesystem::path& file);

/// What the journal says of each file, or the file itself where the journal is silent.
class ShardRecords {
 public:
  explicit ShardRecords(const SweepFolder& folder);

  /// Of a shard that is there; failures as the last retry left them. Throws InputError.
  JournalEntry get(std::int64_t shard);
  /// Lines that were no lines; entries of work done twice.
  std::size_t bad_lines() const { return journal_.bad_lines; }
  std::int64_t duplicates() const { return duplicates_; }
  const Journal& journal() const { return journal_; }

 private:
  JournalEntry get_file(const std::filesystem::path& file);

  SweepFolder folder_;
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
