#include "sweep/run.h"

#include <omp.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <system_error>

#include "sweep/shard_source.h"
#include "sweep/shard_store.h"
#include "sweep/shard_writer.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

/// What runners that are gone have left in tmp/: files OWNER.NUMBER.
void remove_leftovers(const SweepFolder& folder, Claims& claims) {
  std::error_code error;
  for (fs::directory_iterator file(folder.temporary(), error), end; !error && file != end;
       file.increment(error)) {
    const std::string owner = file->path().stem().string();
    std::error_code gone;
    if (owner != claims.runner() && !claims.may_live(owner)) fs::remove(file->path(), gone);
  }
}

/// Calls `work(thread)` on every thread of a team; the first exception stops all and comes out.
template <class Work>
void run_team(int threads, std::atomic<bool>& halt, const Work& work) {
  std::exception_ptr failure;
  std::mutex mutex;
#pragma omp parallel num_threads(threads)
  {
    try {
      work();
    } catch (...) {
      halt = true;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// One sweep, one runner.
class Run {
 public:
  Run(const SweepFolder& folder, const Plan& plan, const RunOptions& options, RunProgress& progress,
      std::atomic<bool>& halt)
      : folder_(folder),
        plan_(plan),
        options_(options),
        progress_(progress),
        halt_(halt),
        schema_(plan.make_schema()),
        claims_(folder.claims(), options.claims) {
    remove_leftovers(folder_, claims_);
  }

  RunSummary run() {
    ShardSource source(folder_, plan_, options_, claims_, progress_);
    summary_.notes = source.notes();
    summary_.shards_written = with_writer([&](ShardWriter& writer) {
      run_team(options_.threads, halt_, [&] { simulate_shards(source, writer); });
    });
    if (options_.retry_failed && !halt_) {
      const std::vector<std::int64_t> shards = list_failing_shards();
      std::atomic<std::size_t> next{0};
      summary_.retries_written = with_writer([&](ShardWriter& writer) {
        run_team(options_.threads, halt_, [&] { retry_shards(shards, next, writer); });
      });
    }
    summary_.stopped = halt_;
    count_failed();
    return summary_;
  }

 private:
  /// Lets `produce` push into a writer; returns the number of files written.
  template <class Produce>
  std::int64_t with_writer(const Produce& produce) {
    ShardWriter writer(folder_, {plan_.hash(), make_provenance()}, claims_, halt_,
                       progress_.written, progress_.failed);
    std::exception_ptr failure;
    try {
      produce(writer);
    } catch (...) {
      failure = std::current_exception();
    }
    const WriterTotals totals = writer.finish();
    if (failure) std::rethrow_exception(failure);
    summary_.duplicates += totals.duplicates;
    summary_.bytes += totals.bytes;
    summary_.write += totals.seconds;
    return totals.shards;
  }

  std::vector<std::pair<std::string, std::string>> make_provenance() const {
    auto texts = options_.provenance;
    texts.emplace_back("instruction_set", options_.kernel->isa);
    texts.emplace_back("threads", std::to_string(options_.threads));
    return texts;
  }

  void simulate_shards(ShardSource& source, ShardWriter& writer) {
    CaseSimulator simulator(plan_, *options_.kernel);
    while (!halt_) {
      const std::optional<Batch> batch = source.next(simulator.batch_size(), halt_);
      if (!batch) break;
      ShardJob& job = *batch->job;
      const double before = simulator.seconds().total();
      if (!simulator.simulate(batch->cases(), job.rows, batch->first_row, halt_)) break;
      job.seconds += simulator.seconds().total() - before;
      progress_.simulated += static_cast<std::int64_t>(batch->count);
      if (job.left.fetch_sub(batch->count) == batch->count) {
        writer.push(finish(job.shard, folder_.shard(job.shard), SweepFolder::shard_name(job.shard),
                           job.rows, job.seconds));
      }
    }
    add_seconds(simulator.seconds());
  }

  /// The failing cases of each shard, one after the other, into one overlay a shard.
  void retry_shards(const std::vector<std::int64_t>& shards, std::atomic<std::size_t>& next,
                    ShardWriter& writer) {
    CaseSimulator simulator(plan_, *options_.kernel);
    for (std::size_t i = next++; i < shards.size() && !halt_; i = next++) {
      const std::string unit = "retry-" + SweepFolder::shard_name(shards[i]);
      if (claims_.claim(unit) != Claims::Answer::kMine) continue;
      const double before = simulator.seconds().total();
      const ShardRows overlay = retry_shard(shards[i], simulator);
      if (overlay.size() == 0 || halt_) {
        claims_.release(unit);
        continue;
      }
      const int round = count_retries(folder_, shards[i]);
      writer.push(finish(shards[i], folder_.retry(shards[i], round), unit, overlay,
                         simulator.seconds().total() - before));
    }
    add_seconds(simulator.seconds());
  }

  ShardRows retry_shard(std::int64_t shard, CaseSimulator& simulator) {
    const ShardRows rows = read_mended_shard(folder_, shard).rows;
    std::vector<std::size_t> failing;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (may_retry(rows.status[row]) && rows.attempt[row] < kLastAttempt) failing.push_back(row);
    }
    ShardRows overlay = ShardRows::make(schema_, failing.size());
    for (std::size_t i = 0; i < failing.size() && !halt_; ++i) {
      const std::size_t row = failing[i];
      simulator.retry(rows.case_id[row], rows.attempt[row] + 1, overlay, i);
      const bool mended = overlay.status[i] == 0;
      const std::lock_guard lock(mutex_);
      ++(mended ? summary_.mended : summary_.still_failing);
    }
    return overlay;
  }

  FinishedShard finish(std::int64_t shard, const fs::path& target, const std::string& unit,
                       const ShardRows& rows, double seconds) {
    const auto start = SteadyClock::now();
    FinishedShard finished{shard, target, unit, compress_shard(schema_, rows),
                           make_journal_entry(folder_, target, rows)};
    finished.entry.seconds = seconds;
    const std::lock_guard lock(mutex_);
    summary_.compress += seconds_since(start);
    return finished;
  }

  /// Calls `act(shard, failures)` for each of the shards asked for that is there.
  template <class Act>
  void for_each_present(const Act& act) {
    ShardRecords records(folder_);
    const std::int64_t end = options_.end_shard < 0 ? plan_.shard_count() : options_.end_shard;
    for (const std::int64_t shard : list_shards(folder_)) {
      if (shard >= options_.first_shard && shard < end) act(shard, records.get(shard).failures);
    }
  }

  std::vector<std::int64_t> list_failing_shards() {
    std::vector<std::int64_t> shards;
    for_each_present([&](std::int64_t shard, const auto& failures) {
      if (!failures.empty()) shards.push_back(shard);
    });
    return shards;
  }

  void count_failed() {
    for_each_present([&](std::int64_t, const auto& failures) {
      for (const auto& [reason, cases] : failures) summary_.failed += cases;
    });
  }

  void add_seconds(const SimulationSeconds& seconds) {
    const std::lock_guard lock(mutex_);
    summary_.simulation += seconds;
  }

  const SweepFolder& folder_;
  const Plan& plan_;
  const RunOptions& options_;
  RunProgress& progress_;
  std::atomic<bool>& halt_;
  const ShardSchema schema_;
  Claims claims_;
  std::mutex mutex_;  // guards summary_ while the team works
  RunSummary summary_;
};

}  // namespace

RunSummary run_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     RunProgress& progress, std::atomic<bool>& halt) {
  return Run(folder, plan, options, progress, halt).run();
}

}  // namespace strut
