#include "sweep/shard_writer.h"

#include <ctime>

#include "io/file/publish.h"
#include "sweep/timer.h"

namespace strut {
namespace {

/// Formats a time as "2026-11-21T09:30:00Z".
std::string format_utc(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace

ShardWriter::ShardWriter(const SweepFolder& folder, Settings settings, Claims& claims,
                         std::atomic<bool>& halt, OnPublished on_published)
    : folder_(folder),
      settings_(std::move(settings)),
      claims_(claims),
      halt_(halt),
      on_published_(std::move(on_published)),
      thread_([this] { work(); }) {}

ShardWriter::~ShardWriter() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ShardWriter::push(FinishedShard shard) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return queue_.size() < settings_.queue_length || failure_; });
  if (failure_) return;
  queue_.push_back(std::move(shard));
  changed_.notify_all();
}

WriterTotals ShardWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  return totals_;
}

void ShardWriter::work() {
  FinishedShard shard;
  while (pop(shard)) {
    try {
      const Timer timer(totals_.seconds);
      write(shard);
    } catch (...) {
      halt_ = true;
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      queue_.clear();
      changed_.notify_all();
      return;
    }
  }
}

bool ShardWriter::pop(FinishedShard& shard) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !queue_.empty() || closed_; });
  if (queue_.empty()) return false;
  shard = std::move(queue_.front());
  queue_.pop_front();
  changed_.notify_all();
  return true;
}

void ShardWriter::write(FinishedShard& shard) {
  JournalEntry& entry = shard.entry;
  entry.time = std::time(nullptr);
  entry.runner = claims_.runner();
  ShardProvenance provenance{settings_.plan_hash, shard.shard, settings_.provenance};
  provenance.texts.emplace_back("runner", entry.runner);
  provenance.texts.emplace_back("finished", format_utc(entry.time));
  provenance.texts.emplace_back("simulation_seconds", std::to_string(entry.seconds));
  const std::vector<std::byte> image = make_shard_image(shard.data, provenance);
  entry.bytes = image.size();
  const Folder target_folder = folder_.open(shard.target.parent_path());
  entry.duplicate = publish(target_folder, shard.target.filename().string(), image,
                            folder_.open(folder_.temporary()), entry.runner) == Published::kPresent;
  entry.sha256 = entry.duplicate ? "" : read_shard_seal(shard.target, image).sha256;
  append_journal(Folder(folder_.root), folder_.journal().filename().string(), entry);
  claims_.release(shard.unit);

  if (entry.duplicate) {
    ++totals_.duplicates;
  } else {
    ++totals_.shards;
    totals_.bytes += entry.bytes;
  }
  on_published_(entry);
}

}  // namespace strut
