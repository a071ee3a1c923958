#include "sweep/run.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "io/store/shard_layout.h"
#include "sweep/clean_up.h"
#include "sweep/shard_source.h"
#include "sweep/shard_store.h"
#include "sweep/shard_writer.h"
#include "sweep/timer.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// The arguments of a run and what follows from them; all threads read it.
struct RunInput {
  const SweepFolder& folder;
  const Plan& plan;
  const RunOptions& options;
  RunProgress& progress;
  std::atomic<bool>& halt;
  const ShardSchema schema;
  const SweepExtent extent;

  bool is_stopping() const { return halt || (options.drain != nullptr && *options.drain); }
};

/// The counts of a run that its threads raise.
class SharedSummary {
 public:
  void add_compress(double seconds) {
    const std::lock_guard lock(mutex_);
    summary_.compress += seconds;
  }
  void add_simulation(const SimulationSeconds& seconds) {
    const std::lock_guard lock(mutex_);
    summary_.simulation += seconds;
  }
  void add_retry(bool mended) {
    const std::lock_guard lock(mutex_);
    ++(mended ? summary_.mended : summary_.still_failing);
  }
  void add_damaged(std::int64_t shard, const std::string& error) {
    const std::lock_guard lock(mutex_);
    summary_.damaged[shard] = error;
  }
  void add_writer(const WriterTotals& totals) {
    const std::lock_guard lock(mutex_);
    summary_.duplicates += totals.duplicates;
    summary_.bytes += totals.bytes;
    summary_.write += totals.seconds;
  }
  /// Call only after the threads have ended.
  RunSummary take() { return std::move(summary_); }

 private:
  std::mutex mutex_;
  RunSummary summary_;
};

void prepare_folder(const SweepFolder& folder) {
  make_subfolders(folder);
  // Fails before hours of work rather than when the first shard is published.
  check_regular(Folder(folder.root).descriptor(), folder.journal().filename().string(),
                folder.journal());
}

ShardWriter::Settings make_writer_settings(const RunInput& run) {
  ShardWriter::Settings settings{run.plan.hash(), run.options.provenance};
  settings.provenance.emplace_back(kInstructionSetKey, run.options.kernel->isa);
  settings.provenance.emplace_back("threads", std::to_string(run.options.threads));
  return settings;
}

ClaimOptions make_claim_options(const RunInput& run) {
  ClaimOptions options = run.options.claims;
  options.count_work = [&progress = run.progress] {
    const std::int64_t written = progress.written;  // first: a case is simulated, then written
    return static_cast<std::uint64_t>(std::max<std::int64_t>(progress.simulated - written, 0));
  };
  return options;
}

/// Calls `produce(writer)` on each thread of a team; returns the number of files written.
template <class Produce>
std::int64_t run_writing_team(const RunInput& run, Claims& claims, SharedSummary& summary,
                              ShardWriter::OnPublished on_published, const Produce& produce) {
  ShardWriter writer(run.folder, make_writer_settings(run), claims, run.halt,
                     std::move(on_published));
  std::exception_ptr failure;
  try {
    run_team(run.options.threads, run.halt, [&] { produce(writer); });
  } catch (...) {
    failure = std::current_exception();
  }
  const WriterTotals totals = writer.finish();
  if (failure) std::rethrow_exception(failure);
  summary.add_writer(totals);
  return totals.shards;
}

FinishedShard make_finished(const RunInput& run, std::int64_t shard, const fs::path& target,
                            const std::string& unit, const ShardRows& rows, double seconds,
                            SharedSummary& summary) {
  double compress = 0.0;
  FinishedShard finished{shard, target, unit, {}, {}};
  {
    const Timer timer(compress);
    finished.data = compress_shard(run.schema, rows);
    finished.entry = make_journal_entry(run.folder, target, rows);
  }
  finished.entry.seconds = seconds;
  summary.add_compress(compress);
  return finished;
}

// --- missing shards --------------------------------------------------------------------------

void count_written(const JournalEntry& entry, RunProgress& progress) {
  if (entry.duplicate) {
    progress.simulated -= entry.cases;
    progress.elsewhere += entry.cases;
  } else {
    progress.written += entry.cases;
    progress.failed += count_failures(entry);
  }
}

/// The work of one thread: simulates batches, and pushes each shard whose last batch it finished.
void simulate_shards(const RunInput& run, ShardSource& source, ShardWriter& writer,
                     SharedSummary& summary) {
  CaseSimulator simulator(run.plan, *run.options.kernel);
  while (!run.halt) {
    const std::optional<Batch> batch = source.next(simulator.batch_size(), run.halt);
    if (!batch) break;
    ShardJob& job = *batch->job;
    const double before = simulator.seconds().total();
    if (!simulator.simulate(batch->cases(), job.rows, batch->first_row, run.halt)) break;
    job.seconds += simulator.seconds().total() - before;
    run.progress.simulated += static_cast<std::int64_t>(batch->count);
    if (job.remaining.fetch_sub(batch->count) == batch->count) {
      writer.push(make_finished(run, job.shard, run.folder.shard(job.shard),
                                SweepFolder::shard_name(job.shard), job.rows, job.seconds.load(),
                                summary));
    }
  }
  summary.add_simulation(simulator.seconds());
}

// --- retries ---------------------------------------------------------------------------------

/// Returns no rows, and notes the error, if the shard is damaged.
ShardRows read_rows(const RunInput& run, std::int64_t shard, SharedSummary& summary) {
  try {
    return read_shard_with_retries(run.folder, run.extent, shard).rows;
  } catch (const InputError& e) {
    summary.add_damaged(shard, e.what());
    return {};
  }
}

/// Retries the failed cases of a shard; returns the rows of its overlay.
ShardRows retry_shard(const RunInput& run, std::int64_t shard, CaseSimulator& simulator,
                      SharedSummary& summary) {
  const ShardRows rows = read_rows(run, shard, summary);
  std::vector<std::size_t> failing;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows.attempt[row] < get_last_attempt(rows.status[row])) failing.push_back(row);
  }
  ShardRows overlay = ShardRows::make(run.schema, failing.size());
  for (std::size_t i = 0; i < failing.size() && !run.halt; ++i) {
    const std::size_t row = failing[i];
    simulator.retry(rows.case_id[row], rows.attempt[row] + 1, overlay, i);
    ++run.progress.retried;
    summary.add_retry(overlay.status[i] == 0);
  }
  return overlay;
}

/// The work of one thread: retries the next of `shards` until none remains.
void retry_shards(const RunInput& run, const std::vector<std::int64_t>& shards,
                  const RetryCounts& before, std::atomic<std::size_t>& next, Claims& claims,
                  ShardWriter& writer, SharedSummary& summary) {
  CaseSimulator simulator(run.plan, *run.options.kernel);
  for (std::size_t i = next++; i < shards.size() && !run.is_stopping(); i = next++) {
    const std::int64_t shard = shards[i];
    const std::string unit = SweepFolder::retry_unit(shard);
    if (claims.claim(unit) != Claims::Answer::kMine) continue;
    const int round = count_retries(run.folder, shard);
    const auto known = before.find(shard);
    const double start = simulator.seconds().total();
    ShardRows overlay;
    // Another runner's round counts as this one's: a resume retries a case once, however many help.
    if (round == (known == before.end() ? 0 : known->second)) {
      overlay = retry_shard(run, shard, simulator, summary);
    }
    if (overlay.size() == 0 || run.halt) {
      claims.release(unit);
      continue;
    }
    writer.push(make_finished(run, shard, run.folder.retry(shard, round), unit, overlay,
                              simulator.seconds().total() - start, summary));
  }
  summary.add_simulation(simulator.seconds());
}

// --- results ---------------------------------------------------------------------------------

/// Calls `act(shard, entry)` for each requested shard that exists and can be read.
template <class Act>
void for_each_present(const RunInput& run, SharedSummary& summary, const Act& act) {
  const ShardRecords records(run.folder, run.extent);
  const std::int64_t end = run.options.find_end_shard(run.plan);
  std::vector<std::int64_t> shards = list_shards(run.folder);
  std::erase_if(shards, [&](std::int64_t s) { return s < run.options.first_shard || s >= end; });
  for (const FoundShard& found : records.read(shards)) {
    if (found.entry) {
      act(found.shard, *found.entry);
    } else {  // one bad file must not stop the others
      summary.add_damaged(found.shard, found.fault);
    }
  }
}

std::vector<std::int64_t> list_failing_shards(const RunInput& run, SharedSummary& summary) {
  std::vector<std::int64_t> shards;
  for_each_present(run, summary, [&](std::int64_t shard, const JournalEntry& entry) {
    if (!entry.failures.empty()) shards.push_back(shard);
  });
  return shards;
}

std::int64_t count_failed(const RunInput& run, SharedSummary& summary) {
  std::int64_t failed = 0;
  for_each_present(run, summary, [&](std::int64_t, const JournalEntry& entry) {
    failed += count_failures(entry);
  });
  return failed;
}

}  // namespace

RunSummary run_sweep(const SweepFolder& folder, const Plan& plan, const RunOptions& options,
                     RunProgress& progress, std::atomic<bool>& halt) {
  const RunInput run{folder, plan, options, progress, halt, plan.make_schema(), plan.make_extent()};
  prepare_folder(folder);
  Claims claims(folder.open(folder.claims()), make_claim_options(run));
  clean_up(folder, claims);
  const RetryCounts before = options.retry_failed ? count_all_retries(folder) : RetryCounts();

  SharedSummary shared;
  ShardSource source(folder, plan, options, claims, progress);
  const std::int64_t shards_written = run_writing_team(
      run, claims, shared, [&](const JournalEntry& entry) { count_written(entry, progress); },
      [&](ShardWriter& writer) { simulate_shards(run, source, writer, shared); });
  std::int64_t retries_written = 0;
  bool none_fails = false;
  if (options.retry_failed && !halt) {
    const std::vector<std::int64_t> shards = list_failing_shards(run, shared);
    none_fails = shards.empty();
    std::atomic<std::size_t> next{0};
    retries_written = run_writing_team(
        run, claims, shared, [](const JournalEntry&) {},
        [&](ShardWriter& writer) {
          retry_shards(run, shards, before, next, claims, writer, shared);
        });
  }

  const bool stopped = halt;
  const std::int64_t failed = none_fails ? 0 : count_failed(run, shared);
  RunSummary summary = shared.take();
  summary.stopped = stopped;
  summary.shards_written = shards_written;
  summary.retries_written = retries_written;
  summary.failed = failed;
  summary.notes = source.notes();
  return summary;
}

}  // namespace strut
