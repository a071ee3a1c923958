#include "io/store/dataset.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "base/error/input_error.h"
#include "io/file/row_store.h"
#include "sweep/merge.h"
#include "tests/support/example_shard.h"
#include "tests/support/flip_bits.h"
#include "tests/support/test_sweep.h"
#include "train/data/dataset_source.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

fs::path write_shard(const fs::path& path, std::int64_t number, const ShardSchema& schema,
                     const ShardRows& rows, const std::string& plan = std::string(64, 'a')) {
  ShardProvenance provenance = test::make_example_provenance(number);
  provenance.plan_hash = plan;
  const auto image = make_shard_image(compress_shard(schema, rows), provenance);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  return path;
}

fs::path write_example(const TemporaryFolder& folder, std::int64_t number, std::size_t count = 20) {
  const ShardSchema schema = test::make_example_schema();
  return write_shard(folder / (std::to_string(number) + ".h5"), number, schema,
                     test::make_example_rows(schema, count, 100 * number));
}

void merge(const test::PlannedSweep& sweep, const fs::path& file) {
  ShardSchema schema = sweep.plan().make_schema();
  schema.history_samples = 0;
  schema.history_interval = 0.0;
  merge_sweep(sweep.folder(), {sweep.plan().make_extent(), schema}, file, {},
              [](std::int64_t) { return true; });
}

void check_same(const ShardRows& a, const ShardRows& b) {
  CHECK(a.case_id == b.case_id);
  CHECK(a.status == b.status);
  CHECK(test::same_bits(a.parameters, b.parameters));
  CHECK(test::same_bits(a.snapshot, b.snapshot));
  CHECK(test::same_bits(a.event_time, b.event_time));
}

TEST_CASE("A folder, its shards in any order and a merged file give the same rows", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  std::vector<fs::path> shards;
  for (const std::int64_t shard : list_shards(folder)) shards.push_back(folder.shard(shard));
  std::reverse(shards.begin(), shards.end());
  const TemporaryFolder files;
  merge(sweep, files / "copy.h5");
  Dataset whole({folder.root});
  REQUIRE(whole.row_count() == 27);
  CHECK(whole.plan_hash() == sweep.plan().hash());
  const ShardRows rows = whole.read(0, 27);
  for (std::size_t i = 0; i < 27; ++i) {
    CHECK(rows.case_id[i] == sweep.plan().calc_case_id(static_cast<std::int64_t>(i)));
  }
  for (const auto& paths : {shards, {files / "copy.h5"}}) {
    Dataset other(paths);
    CHECK(other.row_count() == 27);
    CHECK(other.schema() == whole.schema());
    check_same(other.read(0, 27), rows);
    check_same(other.read(3, 9), whole.read(3, 9));
  }
  CHECK_THROWS_WITH(whole.read(20, 8), Contains("has 27 rows"));
}

TEST_CASE("A sweep folder that lacks shards is refused unless partial data are allowed", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  fs::remove(sweep.folder().shard(1));
  CHECK_THROWS_WITH(Dataset({sweep.folder().root}),
                    Contains("5 of 27 cases are missing") && Contains("--partial"));
  CHECK(Dataset({sweep.folder().root}, {.partial = true}).row_count() == 22);
}

TEST_CASE("Files of another plan, of other columns, or given twice are refused by name", "[io]") {
  const TemporaryFolder folder;
  const fs::path one = write_example(folder, 1), two = write_example(folder, 2);
  CHECK(Dataset({one, two}).row_count() == 40);
  const ShardSchema schema = test::make_example_schema();
  const ShardRows rows = test::make_example_rows(schema, 5);
  const fs::path foreign =
      write_shard(folder / "foreign.h5", 3, schema, rows, std::string(64, 'b'));
  CHECK_THROWS_WITH(Dataset({one, foreign}), Contains("foreign.h5: belongs to plan") &&
                                                 Contains("1.h5") && Contains("bbbb"));
  ShardSchema other = schema;
  other.parameters[0].unit = "kN/m";
  const fs::path misfit = write_shard(folder / "misfit.h5", 3, other, rows);
  CHECK_THROWS_WITH(Dataset({one, misfit}), Contains("misfit.h5: its columns differ"));
  CHECK_THROWS_WITH(Dataset({one, two, one}), Contains("shard 1 is given twice"));
  CHECK_THROWS_WITH(Dataset({folder / "none.h5"}), Contains("none.h5: not found"));
  CHECK_THROWS_WITH(Dataset({folder / "."}), Contains("not a sweep folder"));
  CHECK_THROWS_AS(Dataset({folder.write("text.h5", "no data")}), InputError);
}

/// Writes a shard of a sweep with a valid seal and other content.
void replace_shard(const fs::path& file, const test::PlannedSweep& sweep, std::int64_t number,
                   const ShardRows& rows) {
  write_shard(file, number, sweep.plan().make_schema(), rows, sweep.plan().hash());
}

TEST_CASE("A folder's shard under a wrong name or of another sweep is refused with a remedy",
          "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  const auto over = fs::copy_options::overwrite_existing;
  const std::string remedy = "`strut verify DIR --quarantine`";

  SECTION("copied") {
    fs::copy_file(folder.shard(1), folder.shard(3), over);
    CHECK_THROWS_WITH(Dataset({folder.root}),
                      Contains("000003.h5: is shard 1 of the plan") && Contains(remedy));
  }
  SECTION("swapped") {
    fs::rename(folder.shard(1), folder.root / "aside");
    fs::rename(folder.shard(3), folder.shard(1));
    fs::rename(folder.root / "aside", folder.shard(3));
    CHECK_THROWS_WITH(Dataset({folder.root}), Contains("000001.h5: is shard 3 of the plan"));
  }
  SECTION("beyond the plan") {
    replace_shard(folder.shard(77), sweep, 77, read_shard(folder.shard(1)).rows);
    CHECK_THROWS_WITH(Dataset({folder.root}), Contains("000077.h5: the plan has no shard 77"));
  }
  SECTION("foreign") {
    test::SweepText text;
    text.integrate = "method = \"rk4\"\nstep = 1e-3\nclosure = \"table\"\n";
    const test::PlannedSweep other(text);
    other.run();
    fs::copy_file(other.folder().shard(0), folder.shard(0), over);
    CHECK_THROWS_WITH(Dataset({folder.root}),
                      Contains("000000.h5: belongs to another plan") && Contains(remedy));
  }
  SECTION("longer, shorter, with a case twice or of no plan") {
    const ShardRows rows = read_shard(folder.shard(1)).rows;
    ShardRows other = ShardRows::make(sweep.plan().make_schema(), 4);
    for (std::size_t row = 0; row < 4; ++row) other.set_row(row, rows, row);
    replace_shard(folder.shard(1), sweep, 1, other);
    CHECK_THROWS_WITH(Dataset({folder.root}),
                      Contains("000001.h5: has 4 cases; the plan has 5 in this shard"));
    other = rows;
    other.case_id[0] = 27;
    replace_shard(folder.shard(1), sweep, 1, other);
    CHECK_THROWS_WITH(Dataset({folder.root}), Contains("000001.h5: case 27 is not in the plan"));
    other.case_id[0] = other.case_id[1];
    replace_shard(folder.shard(1), sweep, 1, other);
    CHECK_THROWS_WITH(Dataset({folder.root}),
                      Contains("000001.h5: holds case") && Contains("twice"));
    other.case_id[0] = read_shard(folder.shard(2)).rows.case_id[0];
    replace_shard(folder.shard(1), sweep, 1, other);
    CHECK_THROWS_WITH(Dataset({folder.root}), Contains("000001.h5") &&
                                                  Contains("000002.h5: case") &&
                                                  Contains("appears twice"));
  }
}

TEST_CASE("A retry of another shard or sweep is refused", "[io]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  fs::create_directories(folder.retries());
  const auto check = [&](const std::string& what) {
    CHECK_THROWS_WITH(
        [&] {
          Dataset dataset({folder.root});
          dataset.read(0, 27);
        }(),
        Contains("retries/000001.0.h5: " + what));
    CHECK_THROWS_WITH(read_shard_with_retries(folder, sweep.plan().make_extent(), 1),
                      Contains("retries/000001.0.h5: " + what));
  };
  const ShardRows rows = read_shard(folder.shard(1)).rows;
  const fs::path file = folder.retry(1, 0);
  const ShardSchema schema = sweep.plan().make_schema();
  write_shard(file, 1, schema, rows, std::string(64, 'b'));
  check("belongs to another plan");
  write_shard(file, 2, schema, rows, sweep.plan().hash());
  check("is shard 2 of the plan");
  ShardRows other = rows;
  other.case_id[0] = other.case_id[1];
  replace_shard(file, sweep, 1, other);
  check("holds case");
  ShardSchema fewer = schema;
  fewer.snapshot.pop_back();
  write_shard(file, 1, fewer, ShardRows::make(fewer, 1), sweep.plan().hash());
  check("its columns differ from those of its shard");
  replace_shard(file, sweep, 1, rows);
  CHECK(Dataset({folder.root}).read(0, 27).case_id[5] == rows.case_id[0]);
}

TEST_CASE("Single shards must have their own number, and no case may occur twice", "[io]") {
  const TemporaryFolder folder;
  const fs::path one = write_example(folder, 1), other = folder / "000002.h5";
  fs::copy_file(one, other);
  CHECK_THROWS_WITH(Dataset({other}), Contains("000002.h5: is shard 1 of the plan"));
  const ShardSchema schema = test::make_example_schema();
  write_shard(other, 2, schema, test::make_example_rows(schema, 20, 119));
  CHECK_THROWS_WITH(Dataset({one, other}),
                    Contains("1.h5") && Contains("000002.h5: case 119 appears twice"));
  CHECK(Dataset({other}).row_count() == 20);
}

TEST_CASE("Every flipped bit of a plan, a shard and a merged file is found by its reader",
          "[io][property]") {
  const test::PlannedSweep sweep;
  sweep.run();
  const SweepFolder& folder = sweep.folder();
  const TemporaryFolder files;
  const fs::path merged = files / "merged.h5";
  merge(sweep, merged);
  const auto read_folder = [&] { Dataset dataset({folder.root}); };
  CHECK(test::count_missed_flips(folder.plan(), read_folder, "`strut plan DIR/request.toml") == 0);
  CHECK(test::count_missed_flips(
            folder.plan(), [&] { open_sweep_folder(folder); }, "`strut plan DIR/request.toml") ==
        0);
  CHECK(test::count_missed_flips(folder.shard(2), read_folder, "--quarantine`") == 0);
  CHECK(test::count_missed_flips(
            merged, [&] { Dataset dataset({merged}); }, "") == 0);
}

TEST_CASE("A row store returns the same rows from memory and from a scratch file",
          "[unit][property]") {
  const TemporaryFolder folder;
  RowStore memory(3), file(3, {.memory = 100, .scratch = folder / "."});
  std::vector<double> all;
  for (int i = 0; i < 60000; ++i) {
    const std::vector<double> row = {i + 0.1, i + 0.2, i + 0.3};
    memory.append(row);
    file.append(row);
    all.insert(all.end(), row.begin(), row.end());
  }
  CHECK(memory.in_memory());
  CHECK(!file.in_memory());
  CHECK(folder.file_count() == 0);  // it has no name
  for (const auto& [first, count] :
       {std::pair{0, 60000}, {0, 1}, {43000, 10000}, {59999, 1}, {12, 0}}) {
    std::vector<double> rows(3 * static_cast<std::size_t>(count));
    const std::vector<double> truth(all.begin() + 3 * first, all.begin() + 3 * (first + count));
    for (const RowStore* store : {&memory, &file}) {
      store->read(static_cast<std::size_t>(first), static_cast<std::size_t>(count), rows.data());
      CHECK(rows == truth);
    }
  }
  RowStore nowhere(1, {.memory = 0, .scratch = folder / "none"});
  CHECK_THROWS_AS(nowhere.append(std::vector<double>{1.0}), EnvironmentError);
}

TEST_CASE("Failed cases and NaN are skipped and counted, and samples are the first usable rows",
          "[unit]") {
  const TemporaryFolder folder;
  const ShardSchema schema = test::make_example_schema();
  ShardRows rows = test::make_example_rows(schema, 20);
  rows.snapshot[2 * 4] = std::nan("");  // status 0
  const fs::path file = write_shard(folder / "a.h5", 1, schema, rows);
  Dataset data({file});
  const UsableRows usable = read_usable_rows(data, {{"body_position_z"}, {"front_damping"}});
  CHECK(usable.rows.row_count() == 14);  // every third failed
  CHECK(usable.skipped == 6);            // the NaN is in a channel that is not used
  const UsableRows other = read_usable_rows(data, {{"pitch_angle"}, {}});
  CHECK(other.rows.row_count() == 13);
  CHECK(other.skipped == 7);
  CHECK(other.targets.size() == 2);
  std::vector<double> row(2);
  usable.rows.read(2, 1, row.data());
  CHECK(row[0] == rows.snapshot[2 * 3 + 1]);
  CHECK(row[1] == rows.parameters[2 * 3 + 1]);
  CHECK(read_usable_rows(data, {{"pitch_angle"}, {}, 5}).rows.row_count() == 5);
  CHECK_THROWS_WITH(read_usable_rows(data, {{"pitch_angle"}, {}, 14}),
                    Contains("13 usable cases of 20") && Contains("asked for 14"));
  CHECK_THROWS_WITH(read_usable_rows(data, {{"pitch_angel"}, {}}),
                    Contains("no snapshot channel 'pitch_angel'") &&
                        Contains("did you mean 'pitch_angle'?") && Contains("body_position_z"));
  CHECK_THROWS_WITH(read_usable_rows(data, {{"pitch_angle", "pitch_angle"}, {}}),
                    Contains("named twice"));
}

TEST_CASE("Parts partition the rows, and bounds are those of the training part", "[property]") {
  UsableRows usable{{{"x", "m", ""}}, {{"p", "N", ""}}, RowStore(2)};
  std::vector<double> truth;
  for (int i = 0; i < 100; ++i) {
    truth.push_back(i);
    usable.rows.append(std::vector<double>{static_cast<double>(i), 2.0 * i});
  }
  const TrainingRows parts = split_rows(std::move(usable), {});
  CHECK(parts.train.row_count() == 70);
  CHECK(parts.validate.row_count() == 15);
  CHECK(parts.test.row_count() == 15);
  std::vector<double> seen, trained;
  for (const RowStore* part : {&parts.train, &parts.validate, &parts.test}) {
    for_each_piece(*part, [&](std::span<const double> rows, std::size_t, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        seen.push_back(rows[2 * i]);
        if (part == &parts.train) trained.push_back(rows[2 * i]);
      }
    });
  }
  CHECK(std::is_sorted(trained.begin(), trained.end()));  // in run order
  CHECK(parts.input_map.low()[0] == trained.front());
  CHECK(parts.input_map.high()[0] == trained.back());
  CHECK(parts.target_map.high()[0] == 2.0 * trained.back());
  std::sort(seen.begin(), seen.end());
  CHECK(seen == truth);

  StoreSource source(parts.train, parts.input_map, parts.target_map);
  std::vector<double> inputs(70), targets(70), input(1), target(1);
  source.read(0, 70, inputs.data(), targets.data());
  CHECK(inputs.front() == -1.0);
  CHECK(inputs.back() == 1.0);
  for (std::size_t i = 0; i < 70; ++i) {
    source.read(i, 1, input.data(), target.data());
    CHECK(input[0] == inputs[i]);
    CHECK(target[0] == targets[i]);
  }
}

TEST_CASE("Rows of the other parts do not extend the bounds, for any seed", "[unit]") {
  int narrower = 0;  // seeds that put the lowest or the highest row in another part
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    UsableRows usable{{{"x", "m", ""}}, {{"p", "N", ""}}, RowStore(2)};
    for (int i = 0; i < 40; ++i) {
      usable.rows.append(std::vector<double>{static_cast<double>(i), 2.0 * i});
    }
    const TrainingRows parts = split_rows(std::move(usable), {.seed = seed});
    double low = 1e300, high = -1e300;
    for_each_piece(parts.train, [&](std::span<const double> rows, std::size_t, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        low = std::min(low, rows[2 * i]);
        high = std::max(high, rows[2 * i]);
      }
    });
    INFO("seed " << seed);
    CHECK(parts.input_map.low()[0] == low);
    CHECK(parts.input_map.high()[0] == high);
    CHECK(parts.target_map.high()[0] == 2.0 * high);
    narrower += low > 0.0 || high < 39.0 ? 1 : 0;
  }
  CHECK(narrower > 0);
}

TEST_CASE("A constant column and too few cases for three parts are refused", "[unit]") {
  UsableRows usable{{{"x", "m", ""}, {"y", "m", ""}}, {{"p", "N", ""}}, RowStore(3)};
  for (int i = 0; i < 20; ++i) {
    usable.rows.append(std::vector<double>{static_cast<double>(i), 0.25, 1.0 * i});
  }
  CHECK_THROWS_WITH(split_rows(std::move(usable), {}),
                    Contains("input 'y' is constant") && Contains("14 training rows"));
  UsableRows few{{{"x", "m", ""}}, {{"p", "N", ""}}, RowStore(2)};
  few.rows.append(std::vector<double>{1.0, 2.0, 3.0, 4.0});
  CHECK_THROWS_WITH(split_rows(std::move(few), {}), Contains("2 usable cases: too few"));
}

}  // namespace
}  // namespace strut
