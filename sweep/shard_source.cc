#include "sweep/shard_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "sweep/shard_store.h"

namespace strut {
namespace {

/// Interval at which shards claimed by other runners are polled.
constexpr std::chrono::milliseconds kPoll{100};

}  // namespace

ShardSource::ShardSource(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                         Claims& claims, RunProgress& progress)
    : folder_(folder),
      plan_(plan),
      drain_(options.drain),
      claims_(claims),
      progress_(progress),
      schema_(plan.make_schema()) {
  scan(options.first_shard, options.find_end_shard(plan));
}

void ShardSource::scan(std::int64_t first, std::int64_t end) {
  std::vector<std::int64_t> existing = list_shards(folder_);
  std::erase_if(existing, [&](std::int64_t shard) { return shard < first || shard >= end; });
  const std::vector<std::string> faults = find_seal_faults(folder_, plan_, existing);
  std::size_t present = 0;
  for (std::int64_t shard = first; shard < end; ++shard) {
    const std::int64_t cases = plan_.shard_size(shard);
    progress_.cases += cases;
    if (present < existing.size() && existing[present] == shard) {
      const std::string& fault = faults[present++];
      if (fault.empty()) {
        progress_.present += cases;
        continue;
      }
      notes_.push_back(
          fmt::format("shard {} moved to quarantine, to be simulated again: {}", shard, fault));
      quarantine(folder_, folder_.shard(shard));
    }
    missing_.push_back(shard);
  }
}

std::optional<Batch> ShardSource::next(std::size_t size, const std::atomic<bool>& halt) {
  while (!halt) {
    {
      const std::lock_guard lock(mutex_);
      if (!job_) {
        const Taken taken = open_job();
        if (taken == Taken::kNoneLeft) return std::nullopt;
      }
      if (job_) {
        const std::size_t count = std::min(size, job_->cases.size() - next_row_);
        Batch batch{job_, next_row_, count};
        next_row_ += count;
        if (next_row_ == job_->cases.size()) job_.reset();
        return batch;
      }
    }
    std::this_thread::sleep_for(kPoll);
  }
  return std::nullopt;
}

ShardSource::Taken ShardSource::open_job() {
  if (drain_ != nullptr && *drain_) return Taken::kNoneLeft;
  while (next_ < missing_.size()) {
    if (take(missing_[next_++])) return Taken::kJob;
  }
  // The runners that held these may have finished or died. One thread polls for all, since network
  // folders are slow.
  const auto now = std::chrono::steady_clock::now();
  if (!elsewhere_.empty() && now < next_poll_) return Taken::kNoneNow;
  next_poll_ = now + kPoll;
  std::vector<std::int64_t> again;
  again.swap(elsewhere_);
  for (std::size_t i = 0; i < again.size(); ++i) {
    if (!take(again[i])) continue;
    elsewhere_.insert(elsewhere_.end(), again.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                      again.end());
    return Taken::kJob;
  }
  return elsewhere_.empty() ? Taken::kNoneLeft : Taken::kNoneNow;
}

bool ShardSource::take(std::int64_t shard) {
  const std::string unit = SweepFolder::shard_name(shard);
  const bool mine = claims_.claim(unit) == Claims::Answer::kMine;
  // Checked after claiming: a shard is published before its claim is released.
  if (std::filesystem::exists(folder_.shard(shard))) {
    if (mine) claims_.release(unit);
    progress_.elsewhere += plan_.shard_size(shard);
    return false;
  }
  if (!mine) {
    elsewhere_.push_back(shard);
    return false;
  }
  job_ = make_job(shard);
  next_row_ = 0;
  return true;
}

std::shared_ptr<ShardJob> ShardSource::make_job(std::int64_t shard) const {
  auto job = std::make_shared<ShardJob>();
  const auto [first, last] = plan_.shard_range(shard);
  job->shard = shard;
  job->cases.reserve(static_cast<std::size_t>(last - first));
  for (std::int64_t position = first; position < last; ++position) {
    job->cases.push_back(plan_.calc_case_id(position));
  }
  job->rows = ShardRows::make(schema_, job->cases.size());
  job->remaining = job->cases.size();
  return job;
}

}  // namespace strut
