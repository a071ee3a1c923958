// The writer thread of a runner: takes compressed shards from a bounded queue, publishes them and
// records them in the journal.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "io/store/claims.h"
#include "io/store/journal.h"
#include "io/store/shard.h"
#include "sweep/folder.h"

namespace strut {

/// A shard, or an overlay of one, ready to be written.
struct FinishedShard {
  std::int64_t shard = 0;
  std::filesystem::path target;
  std::string unit;  // the claim under which it was made
  CompressedShard data;
  JournalEntry entry;  // the writer sets bytes, hash, time and runner
};

struct WriterTotals {
  std::int64_t shards = 0, duplicates = 0;
  std::uint64_t bytes = 0;
  double seconds = 0.0;
};

class ShardWriter {
 public:
  struct Settings {
    std::string plan_hash;
    std::vector<std::pair<std::string, std::string>> provenance;
    std::size_t queue_length = 4;
  };

  /// Called by the writer's thread with each entry that it appended to the journal.
  using OnPublished = std::function<void(const JournalEntry&)>;

  /// Sets `halt` if writing fails. The references must outlive the writer.
  ShardWriter(const SweepFolder& folder, Settings settings, Claims& claims, std::atomic<bool>& halt,
              OnPublished on_published);
  /// Like finish(), without the exception.
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Waits while the queue is full. Drops the shard if writing has failed.
  void push(FinishedShard shard);

  /// Writes the queued shards and ends the thread. Rethrows the exception that made writing fail.
  WriterTotals finish();

 private:
  void work();
  bool pop(FinishedShard& shard);
  void write(FinishedShard& shard);

  const SweepFolder& folder_;
  const Settings settings_;
  Claims& claims_;
  std::atomic<bool>& halt_;
  const OnPublished on_published_;
  WriterTotals totals_;  // the thread's until it has ended

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FinishedShard> queue_;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace strut
