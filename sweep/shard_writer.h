// The one thread of a runner that writes: takes compressed shards from a bounded queue, publishes
// them, and tells the journal.
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
  std::string unit;  // the claim it was made under
  CompressedShard data;
  JournalEntry entry;  // all but bytes, hash, time and runner
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

  /// Called from the writer's thread with what the journal was told.
  using OnPublished = std::function<void(const JournalEntry&)>;

  /// `halt` turns true where writing fails. The references must outlive it.
  ShardWriter(const SweepFolder& folder, Settings settings, Claims& claims, std::atomic<bool>& halt,
              OnPublished on_published);
  /// As finish(), but for the exception.
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Waits while the queue is full. After a failure shards are dropped.
  void push(FinishedShard shard);

  /// Writes what is queued and ends the thread. Throws what made it fail.
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
  WriterTotals totals_;  // the thread's own until it has ended

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FinishedShard> queue_;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace strut
