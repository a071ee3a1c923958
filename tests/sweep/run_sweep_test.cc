// Runs of sweeps: the same data however they are run, and no work done twice.
#include <omp.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <thread>

#include "io/store/claims.h"
#include "io/store/journal.h"
#include "sweep/shard_store.h"
#include "sweep/status.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::PlannedSweep;
using test::SweepText;

RunOptions make_options(int threads) {
  RunOptions options;
  options.kernel = &list_kernels().front();
  options.threads = threads;
  return options;
}

std::string get_digest(const PlannedSweep& sweep) {
  const VerifyReport report = sweep.verify();
  CHECK(report.ok());
  return report.data_digest;
}

int count_files(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST_CASE("The data digest is the same for any number of threads and shards",
          "[unit][property][threads]") {
  SweepText text;
  text.history = "history = { rate = 50, channels = [\"pitch_rate\"] }";
  std::vector<std::string> digests;
  for (const int shard_cases : {1, 4, 27, 1000}) {
    for (const int threads : {1, 2, 5}) {
      text.shard_cases = shard_cases;
      const PlannedSweep sweep(text);
      const RunSummary summary = sweep.run(threads);
      CHECK(summary.shards_written == sweep.plan().shard_count());
      digests.push_back(get_digest(sweep));
      CHECK(digests.back() == digests.front());
    }
  }
}

TEST_CASE("The data of another plan have another digest", "[unit]") {
  SweepText text;
  const PlannedSweep sweep(text);
  text.integrate = "method = \"rk4\"\nstep = 1e-3\nclosure = \"table\"\n";
  const PlannedSweep other(text);
  sweep.run();
  other.run();
  CHECK(get_digest(sweep) != get_digest(other));
}

TEST_CASE("A stopped sweep continues where it stopped and ends with the same data",
          "[unit][property][threads]") {
  const PlannedSweep whole, stopped;
  whole.run();
  const RunOptions options = make_options(2);
  int rounds = 0;
  for (bool complete = false; !complete; ++rounds) {
    REQUIRE(rounds < 100);
    RunProgress progress;
    std::atomic<bool> halt{false};
    std::thread stopper([&] {
      while (progress.written == 0 && progress.present + progress.written < 27 && !halt) {
        std::this_thread::yield();
      }
      halt = true;
    });
    const RunSummary summary = run_sweep(stopped.folder(), stopped.plan(), options, progress, halt);
    halt = true;
    stopper.join();
    CHECK(count_files(stopped.folder().temporary()) == 0);
    CHECK(count_files(stopped.folder().claims()) == 0);
    complete = progress.present == 27;
  }
  CHECK(rounds >= 2);
  CHECK(get_digest(stopped) == get_digest(whole));
  CHECK(read_journal(stopped.folder().journal()).entries.size() == 6);
}

TEST_CASE("A sweep half done here and finished in a copy elsewhere ends with the same data",
          "[unit][property][io]") {
  const PlannedSweep whole, begun;
  whole.run();
  RunOptions options = make_options(1);
  options.end_shard = 2;
  RunProgress here, there;
  std::atomic<bool> halt{false};
  run_sweep(begun.folder(), begun.plan(), options, here, halt);
  REQUIRE(here.written < 27);

  const test::TemporaryFolder elsewhere;
  const SweepFolder copy{elsewhere / "moved"};
  fs::copy(begun.folder().root, copy.root, fs::copy_options::recursive);
  fs::rename(begun.folder().root, elsewhere / "gone");  // its paths lead nowhere
  const Plan plan = open_sweep_folder(copy);
  options = make_options(2);
  run_sweep(copy, plan, options, there, halt);
  CHECK(there.present == here.written);
  CHECK(there.present + there.written == 27);
  const VerifyReport report =
      verify_sweep(copy, plan, {.fallback = &list_kernels().front()}, [](std::int64_t) {});
  CHECK(report.ok());
  CHECK(report.data_digest == get_digest(whole));
}

TEST_CASE("Running a complete sweep again does nothing", "[unit]") {
  const PlannedSweep sweep;
  CHECK(sweep.run().shards_written == 6);
  const auto time = fs::last_write_time(sweep.folder().shard(3));
  const RunSummary again = sweep.run(2);
  CHECK(again.shards_written == 0);
  CHECK(again.simulation.total() == 0.0);
  CHECK(fs::last_write_time(sweep.folder().shard(3)) == time);
}

TEST_CASE("Two runners on one folder share the work", "[unit][threads]") {
  SweepText text;
  text.shard_cases = 1;
  const PlannedSweep alone(text), shared(text);
  alone.run();
  RunSummary summaries[2];
  const auto work = [&](int i) { summaries[i] = shared.run(1); };
  std::thread other(work, 1);
  work(0);
  other.join();
  CHECK(summaries[0].shards_written + summaries[1].shards_written == 27);
  CHECK(summaries[0].shards_written > 0);
  CHECK(summaries[1].shards_written > 0);
  CHECK(summaries[0].duplicates + summaries[1].duplicates == 0);
  CHECK(get_digest(shared) == get_digest(alone));
}

TEST_CASE("Only the requested range of shards is simulated", "[unit]") {
  const PlannedSweep sweep;
  RunOptions options = make_options(2);
  options.first_shard = 2;
  options.end_shard = 4;
  RunProgress progress;
  std::atomic<bool> halt{false};
  run_sweep(sweep.folder(), sweep.plan(), options, progress, halt);
  CHECK(list_shards(sweep.folder()) == std::vector<std::int64_t>{2, 3});
  CHECK(progress.cases == 10);
  CHECK(progress.written == 10);
}

TEST_CASE("A truncated shard is moved to quarantine and simulated again", "[unit][io]") {
  const PlannedSweep sweep;
  sweep.run();
  const std::string before = get_digest(sweep);
  fs::resize_file(sweep.folder().shard(1), 700);
  fs::resize_file(sweep.folder().shard(4), 0);
  const RunSummary again = sweep.run();
  CHECK(again.shards_written == 2);
  CHECK(again.notes.size() == 2);
  CHECK(count_files(sweep.folder().quarantine()) == 2);
  CHECK(get_digest(sweep) == before);
}

TEST_CASE("Status does not count a shard whose seal, size, number or data are wrong",
          "[unit][io]") {
  const PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  const std::string digest = get_digest(sweep);
  const fs::path file = folder.shard(1);
  const auto check_fault = [&](const std::string& what) {
    const SweepStatus status = read_status(folder, sweep.plan());
    CHECK(status.done == 22);
    CHECK(status.left == 5);
    CHECK(status.shards_present == 5);
    CHECK(!status.complete());
    REQUIRE(status.faults.size() == 1);
    CHECK_THAT(status.faults[0], Contains("000001.h5: " + what) && Contains("--quarantine"));
  };
  SECTION("empty") {
    fs::resize_file(file, 0);
    check_fault("damaged");
  }
  SECTION("truncated") {
    fs::resize_file(file, 700);
    check_fault("damaged: has 700 bytes");
  }
  SECTION("garbage") {
    std::ofstream(file) << std::string(9000, 'x');
    check_fault("damaged, or not a shard");
  }
  SECTION("the copy of another shard") {
    fs::copy_file(folder.shard(2), file, fs::copy_options::overwrite_existing);
    check_fault("is shard 2");
  }
  CHECK(sweep.run().shards_written == 1);
  CHECK(read_status(folder, sweep.plan()).complete());
  CHECK(get_digest(sweep) == digest);
}

TEST_CASE("Status reports valid shards whose data differ from the journal", "[unit][io]") {
  const PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  const Shard shard = read_shard(folder.shard(1));
  const auto replace = [&](const ShardRows& rows) {
    test::write_bytes(folder.shard(1), make_shard_image(compress_shard(shard.schema, rows),
                                                        {sweep.plan().hash(), 1, {}}));
  };
  replace(shard.rows);  // simulated again, before the journal was written
  CHECK(read_status(folder, sweep.plan()).faults.empty());
  ShardRows other = shard.rows;
  other.snapshot[4] += 1.0;
  replace(other);
  const SweepStatus status = read_status(folder, sweep.plan());
  CHECK(status.left == 5);
  REQUIRE(status.faults.size() == 1);
  CHECK_THAT(status.faults[0], Contains("000001.h5: does not hold the data"));
  fs::copy_file(folder.shard(2), folder.shard(77));
  CHECK(read_status(folder, sweep.plan()).faults.size() == 2);
}

TEST_CASE("Files of a dead runner are removed, those of a living one are not", "[unit][io]") {
  const PlannedSweep sweep;
  std::ofstream(sweep.folder().temporary() / "nowhere.1.0123456789abcdef.7") << "half a shard";
  const Claims living(Folder(sweep.folder().claims()), {});
  const fs::path theirs = sweep.folder().temporary() / (living.runner() + ".0");
  std::ofstream(theirs) << "half a shard";
  sweep.run();
  CHECK(!fs::exists(sweep.folder().temporary() / "nowhere.1.0123456789abcdef.7"));
  CHECK(fs::exists(theirs));
}

TEST_CASE("Claims of a killed runner on finished work are removed", "[unit][io]") {
  const PlannedSweep sweep;
  sweep.run();
  for (const char* unit : {"000001", "retry-000002"}) {
    std::ofstream(sweep.folder().claims() / unit) << "nowhere.1.abc\n";
  }
  sweep.run();
  CHECK(count_files(sweep.folder().claims()) == 0);
}

TEST_CASE("A folder without its empty subfolders can be run", "[unit][io]") {
  const PlannedSweep sweep;
  const SweepFolder& folder = sweep.folder();
  for (const fs::path& path : {folder.claims(), folder.temporary(), folder.shards()}) {
    fs::remove(path);
  }
  CHECK(sweep.run().shards_written == 6);
  get_digest(sweep);
}

SweepText make_unstable() {
  SweepText text;
  // At 4 ms even a quarter of the step is too long for the stiffest damper.
  text.grid = "front_damping = { from = 2000, to = 98000, count = 7 }\n";
  text.sample = "strata = 2\n";
  text.integrate = "method = \"rk4\"\nstep = 8e-3\nclosure = \"table\"\n";
  text.shard_cases = 3;
  return text;
}

TEST_CASE("A later resume mends failed cases in overlays", "[unit][threads]") {
  const PlannedSweep sweep(make_unstable());
  const RunSummary first = sweep.run();
  CHECK(first.failed > 0);
  const std::string before = get_digest(sweep);
  const SweepStatus status = read_status(sweep.folder(), sweep.plan());
  CHECK(status.failed == first.failed);
  CHECK(status.failures.count("diverged") + status.failures.count("out_of_travel") > 0);
  CHECK(status.complete());
  const auto time = fs::last_write_time(sweep.folder().shard(2));

  const RunSummary second = sweep.run(2, true);
  CHECK(second.mended == first.failed);
  CHECK(second.failed == 0);
  CHECK(second.retries_written > 0);
  CHECK(fs::last_write_time(sweep.folder().shard(2)) == time);
  CHECK(get_digest(sweep) != before);
  CHECK(read_status(sweep.folder(), sweep.plan()).failed == 0);
  CHECK(sweep.verify(7).ok());

  const RunSummary third = sweep.run(2, true);
  CHECK(third.retries_written == 0);
}

TEST_CASE("A resume retries a case once, however many runners help", "[unit][threads]") {
  SweepText text = make_unstable();
  text.integrate = "method = \"rk4\"\nstep = 2e-2\nclosure = \"table\"\n";
  const PlannedSweep sweep(text);
  const SweepFolder& folder = sweep.folder();
  sweep.run(2);
  RunOptions options = make_options(1);
  options.retry_failed = true;
  std::atomic<bool> halt{false};
  {
    // The first runner waits for a shard that another one holds; the second retries all others.
    Claims holder(Folder(folder.claims()), {});
    const std::string unit = SweepFolder::shard_name(2);
    REQUIRE(holder.claim(unit) == Claims::Answer::kMine);
    fs::remove(folder.shard(2));
    RunProgress waiting, helping;
    std::thread first([&] { run_sweep(folder, sweep.plan(), options, waiting, halt); });
    while (waiting.present < 6) std::this_thread::yield();
    RunOptions others = options;
    others.end_shard = 2;
    CHECK(run_sweep(folder, sweep.plan(), others, helping, halt).retries_written > 0);
    holder.release(unit);
    first.join();
  }
  int still_failing = 0;
  for (const std::int64_t shard : list_shards(folder)) {
    const ShardRows rows = read_shard_with_retries(folder, sweep.plan().make_extent(), shard).rows;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      CHECK(rows.attempt[row] <= 2);
      still_failing += rows.status[row] != 0 ? 1 : 0;
    }
  }
  CHECK(still_failing > 0);
}

TEST_CASE("Status counts finished cases from the files alone", "[unit]") {
  const PlannedSweep sweep;
  SweepStatus status = read_status(sweep.folder(), sweep.plan());
  CHECK(status.cases == 27);
  CHECK(status.left == 27);
  CHECK(!status.complete());
  sweep.run();
  status = read_status(sweep.folder(), sweep.plan());
  CHECK(status.done == 27);
  CHECK(status.left == 0);
  CHECK(status.running == 0);
  CHECK(status.complete());
  const std::string digest = status.digest.text();
  CHECK(digest == get_digest(sweep));

  // The journal is only a cache.
  fs::remove(sweep.folder().journal());
  fs::remove(sweep.folder().shard(5));
  status = read_status(sweep.folder(), sweep.plan());
  CHECK(status.done == 25);
  CHECK(status.left == 2);
}

TEST_CASE("Status tells how many cases of claimed shards are simulated", "[unit]") {
  SweepText text;
  text.shard_cases = 10;
  const PlannedSweep sweep(text);
  ClaimOptions options{std::chrono::milliseconds(5), std::chrono::milliseconds(1000000)};
  std::atomic<std::uint64_t> work{0};
  options.count_work = [&] { return work.load(); };
  Claims claims(Folder(sweep.folder().root).make_folder("claims"), options);
  REQUIRE(claims.claim(SweepFolder::shard_name(1)) == Claims::Answer::kMine);
  const auto wait_for = [&](std::int64_t simulated) {
    for (int i = 0; i < 2000; ++i) {
      if (read_status(sweep.folder(), sweep.plan()).simulated == simulated) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  };
  CHECK(wait_for(0));
  CHECK(read_status(sweep.folder(), sweep.plan()).running == 10);
  work = 7;
  CHECK(wait_for(7));
  work = 1000;  // the heartbeat of a shard that was published since
  CHECK(wait_for(10));
}

TEST_CASE("Runners tell the cases that they simulated and did not publish", "[unit][threads]") {
  SweepText text;
  text.shard_cases = 27;
  const PlannedSweep sweep(text);
  RunOptions options = make_options(1);
  options.claims.heartbeat = std::chrono::milliseconds(1);
  RunProgress progress;
  std::atomic<bool> halt{false};
  std::thread run([&] { run_sweep(sweep.folder(), sweep.plan(), options, progress, halt); });
  bool is_inside = false;  // a shard
  while (!is_inside && progress.written == 0) {
    const SweepStatus status = read_status(sweep.folder(), sweep.plan());
    is_inside = status.simulated > 0 && status.simulated < status.running;
  }
  halt = true;
  run.join();
  CHECK(is_inside);
  CHECK(read_status(sweep.folder(), sweep.plan()).simulated == 0);
}

}  // namespace
}  // namespace strut
