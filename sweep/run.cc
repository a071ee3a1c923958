#include "sweep/run.h"

#include <exception>
#include <mutex>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "sweep/leftovers.h"
#include "sweep/shard_source.h"
#include "sweep/shard_store.h"
#include "sweep/shard_writer.h"
#include "sweep/timer.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

const SweepFolder& prepare(const SweepFolder& folder) {
  make_subfolders(folder);
  // Before hours of work, not behind the first shard.
  check_regular(Folder(folder.root).descriptor(), folder.journal().filename().string(),
                folder.journal());
  return folder;
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
        extent_(plan.make_extent()),
        claims_(prepare(folder).open(folder.claims()), options.claims) {
    remove_leftovers(folder_, claims_);
    if (options_.retry_failed) rounds_before_ = count_all_retries();
  }

  RunSummary run() {
    ShardSource source(folder_, plan_, options_, claims_, progress_);
    summary_.notes = source.notes();
    summary_.shards_written = with_writer(
        [&](ShardWriter& writer) {
          run_team(options_.threads, halt_, [&] { simulate_shards(source, writer); });
        },
        [this](const JournalEntry& entry) { count_written(entry); });
    if (options_.retry_failed && !halt_) {
      const std::vector<std::int64_t> shards = list_failing_shards();
      std::atomic<std::size_t> next{0};
      summary_.retries_written = with_writer(
          [&](ShardWriter& writer) {
            run_team(options_.threads, halt_, [&] { retry_shards(shards, next, writer); });
          },
          [](const JournalEntry&) {});
    }
    summary_.stopped = halt_;
    count_failed();
    return summary_;
  }

 private:
  /// Lets `produce` push into a writer; returns the number of files written.
  template <class Produce>
  std::int64_t with_writer(const Produce& produce, ShardWriter::OnPublished on_published) {
    ShardWriter writer(folder_, {plan_.hash(), make_provenance()}, claims_, halt_,
                       std::move(on_published));
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

  void count_written(const JournalEntry& entry) {
    if (entry.duplicate) {
      progress_.simulated -= entry.cases;
      progress_.elsewhere += entry.cases;
    } else {
      progress_.written += entry.cases;
      progress_.failed += count_failures(entry);
    }
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
        writer.push(make_finished(job.shard, folder_.shard(job.shard),
                                  SweepFolder::shard_name(job.shard), job.rows,
                                  job.seconds.load()));
      }
    }
    add_seconds(simulator.seconds());
  }

  /// The failing cases of each shard, one after the other, into one overlay a shard.
  void retry_shards(const std::vector<std::int64_t>& shards, std::atomic<std::size_t>& next,
                    ShardWriter& writer) {
    CaseSimulator simulator(plan_, *options_.kernel);
    for (std::size_t i = next++; i < shards.size() && !halt_ && !is_drained(); i = next++) {
      const std::int64_t shard = shards[i];
      const std::string unit = SweepFolder::retry_unit(shard);
      if (claims_.claim(unit) != Claims::Answer::kMine) continue;
      const int round = count_retries(folder_, shard);
      const double before = simulator.seconds().total();
      ShardRows overlay;
      // Another runner's round counts as this one's: a resume tries a case once, however many help.
      if (round == find_rounds_before(shard)) overlay = retry_shard(shard, simulator);
      if (overlay.size() == 0 || halt_) {
        claims_.release(unit);
        continue;
      }
      writer.push(make_finished(shard, folder_.retry(shard, round), unit, overlay,
                                simulator.seconds().total() - before));
    }
    add_seconds(simulator.seconds());
  }

  bool is_drained() const { return options_.drain != nullptr && *options_.drain; }

  /// None, and told, where the shard is damaged.
  ShardRows read_rows(std::int64_t shard) {
    try {
      return read_shard_with_retries(folder_, extent_, shard).rows;
    } catch (const InputError& e) {
      const std::lock_guard lock(mutex_);
      summary_.damaged[shard] = e.what();
      return {};
    }
  }

  ShardRows retry_shard(std::int64_t shard, CaseSimulator& simulator) {
    const ShardRows rows = read_rows(shard);
    std::vector<std::size_t> failing;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (may_retry(rows.status[row]) && rows.attempt[row] < kLastAttempt) failing.push_back(row);
    }
    ShardRows overlay = ShardRows::make(schema_, failing.size());
    for (std::size_t i = 0; i < failing.size() && !halt_; ++i) {
      const std::size_t row = failing[i];
      simulator.retry(rows.case_id[row], rows.attempt[row] + 1, overlay, i);
      ++progress_.retried;
      const bool mended = overlay.status[i] == 0;
      const std::lock_guard lock(mutex_);
      ++(mended ? summary_.mended : summary_.still_failing);
    }
    return overlay;
  }

  std::map<std::int64_t, int> count_all_retries() const {
    std::map<std::int64_t, int> rounds;
    for (const std::int64_t shard : list_shards(folder_)) {
      const int count = count_retries(folder_, shard);
      if (count > 0) rounds[shard] = count;
    }
    return rounds;
  }

  int find_rounds_before(std::int64_t shard) const {
    const auto known = rounds_before_.find(shard);
    return known == rounds_before_.end() ? 0 : known->second;
  }

  FinishedShard make_finished(std::int64_t shard, const fs::path& target, const std::string& unit,
                              const ShardRows& rows, double seconds) {
    double compress = 0.0;
    FinishedShard finished{shard, target, unit, {}, {}};
    {
      const Timer timer(compress);
      finished.data = compress_shard(schema_, rows);
      finished.entry = make_journal_entry(folder_, target, rows);
    }
    finished.entry.seconds = seconds;
    const std::lock_guard lock(mutex_);
    summary_.compress += compress;
    return finished;
  }

  /// Calls `act(shard, entry)` for each of the shards asked for that is there and can be read.
  template <class Act>
  void for_each_present(const Act& act) {
    const ShardRecords records(folder_, extent_);
    const std::int64_t end = options_.find_end_shard(plan_);
    for (const std::int64_t shard : list_shards(folder_)) {
      if (shard < options_.first_shard || shard >= end) continue;
      try {
        act(shard, records.get(shard));
      } catch (const InputError& e) {  // one bad file must not stop the rest
        summary_.damaged[shard] = e.what();
      }
    }
  }

  std::vector<std::int64_t> list_failing_shards() {
    std::vector<std::int64_t> shards;
    for_each_present([&](std::int64_t shard, const JournalEntry& entry) {
      if (!entry.failures.empty()) shards.push_back(shard);
    });
    return shards;
  }

  void count_failed() {
    for_each_present(
        [&](std::int64_t, const JournalEntry& entry) { summary_.failed += count_failures(entry); });
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
  const SweepExtent extent_;
  Claims claims_;
  std::map<std::int64_t, int> rounds_before_;  // shards that were retried before this run began
  std::mutex mutex_;                           // guards summary_ while the team works
  RunSummary summary_;
};

}  // namespace

RunSummary run_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     RunProgress& progress, std::atomic<bool>& halt) {
  return Run(folder, plan, options, progress, halt).run();
}

}  // namespace strut
