// The journal of a sweep folder: one checksummed line per finished shard. It is a cache: its
// content can be read from the shards at any time, so a torn or missing line costs time, never
// data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/file/folder.h"

namespace strut {

struct JournalEntry {
  std::string file;  // "shards/000042.h5", relative to the folder
  std::int64_t cases = 0;
  std::map<std::string, std::int64_t> failures;  // reason -> cases
  std::uint64_t bytes = 0;
  std::string sha256;     // digest of the seal
  std::string digest;     // DataDigest::state()
  double seconds = 0.0;   // simulation time, summed over threads
  std::int64_t time = 0;  // s since 1970, for display and rates only
  std::string runner;
  bool duplicate = false;  // another runner published the shard first: the work was done twice
};

/// Appends one line with one write(2) to a file opened with O_APPEND, and flushes it: writers on
/// one host never overwrite each other; on a network file system, which may not support O_APPEND, a
/// line may be lost. A line that an earlier crash left without end is ended first. Throws
/// EnvironmentError; InputError if a link or pipe stands in place of the journal.
///
///     file=shards/000042.h5 cases=512 failures=diverged:3 bytes=... ... check=0123456789abcdef
///
/// Values are percent-encoded; `check` is the first 16 digits of the SHA-256 of all before it.
void append_journal(const Folder& folder, const std::string& journal, const JournalEntry& entry);

struct Journal {
  std::vector<JournalEntry> entries;  // in the order of the file
  std::size_t bad_lines = 0;          // torn or changed; whole entries in them still count
};

/// Reads a journal; a missing file is an empty journal. Throws EnvironmentError if the file cannot
/// be read.
Journal read_journal(const std::filesystem::path& journal);

}  // namespace strut
