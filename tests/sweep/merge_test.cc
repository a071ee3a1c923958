#include "sweep/merge.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "io/file/file_bytes.h"
#include "io/format/hdf5_stream.h"
#include "tests/support/example_shard.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_example_rows;
using test::make_example_schema;
using test::same_bits;
using test::TemporaryFolder;
namespace fs = std::filesystem;

constexpr std::size_t kCases = 20;

void write_file(const fs::path& path, const std::vector<std::byte>& image) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
}

ShardRows make_rows(std::int64_t shard) {
  return make_example_rows(make_example_schema(), kCases, 1000 - 100 * shard);
}

void write_shard(const fs::path& path, std::int64_t shard, const ShardRows& rows) {
  write_file(path, make_shard_image(compress_shard(make_example_schema(), rows),
                                    test::make_example_provenance(shard)));
}

/// Rows 4, 5 and 8 of a shard, mended, the first two in swapped order.
ShardRows make_overlay(std::int64_t shard) {
  const ShardRows rows = make_rows(shard);
  ShardRows overlay = ShardRows::make(make_example_schema(), 3);
  overlay.set_row(0, rows, 5);
  overlay.set_row(1, rows, 4);
  overlay.set_row(2, rows, 8);
  for (std::size_t i = 0; i < 3; ++i) {
    overlay.status[i] = 0;
    overlay.attempt[i] = 2;
    overlay.snapshot[2 * i] = 77.0 + static_cast<double>(i);
    overlay.reason[i] = "a reason longer than all that the shard itself has";
  }
  return overlay;
}

/// Three shards; the second has a retry.
SweepFolder make_sweep(const TemporaryFolder& folder) {
  SweepFolder sweep{folder / "sweep"};
  for (std::int64_t shard = 0; shard < 3; ++shard) {
    write_shard(sweep.shard(shard), shard, make_rows(shard));
  }
  write_shard(sweep.retry(1, 0), 1, make_overlay(1));
  return sweep;
}

MergeInput make_input() {
  return {{std::string(64, 'a'), 2000, 3 * kCases, kCases, {}}, make_example_schema()};
}

/// All rows in the order of the plan, with the mended ones replaced.
ShardRows list_rows() {
  ShardRows all = ShardRows::make(make_example_schema(), 3 * kCases);
  for (std::size_t i = 0; i < 3 * kCases; ++i) {
    all.set_row(i, make_rows(static_cast<std::int64_t>(i / kCases)), i % kCases);
  }
  all.set_row(kCases + 5, make_overlay(1), 0);
  all.set_row(kCases + 4, make_overlay(1), 1);
  all.set_row(kCases + 8, make_overlay(1), 2);
  return all;
}

MergeReport merge(const SweepFolder& sweep, const fs::path& output, bool partial = false) {
  MergeOptions options;
  options.partial = partial;
  options.provenance = {{"strut_version", "0.1.0"}};
  return merge_sweep(sweep, make_input(), output, options, [](std::int64_t) { return true; });
}

/// Reasons are stored by character.
std::vector<std::string> read_reasons(const Hdf5Reader& file) {
  const std::vector<std::string> characters = file.read_texts("/reason");
  const std::size_t length = file.read_shape("/reason").back();
  std::vector<std::string> reasons(characters.size() / length);
  for (std::size_t i = 0; i < characters.size(); ++i) reasons[i / length] += characters[i];
  return reasons;
}

void check_content(const fs::path& path, const ShardRows& rows) {
  const Hdf5Reader file(path);
  CHECK(file.read_integers("/case_id") == rows.case_id);
  CHECK(same_bits(file.read("/parameters").values, rows.parameters));
  CHECK(same_bits(file.read("/snapshot").values, rows.snapshot));
  CHECK(same_bits(file.read("/event_time").values, rows.event_time));
  CHECK(same_bits(file.read("/failure_time").values, rows.failure_time));
  CHECK(same_bits(file.read("/history/body_acceleration_z").values, rows.history[1]));
  CHECK(same_bits(file.read("/history/pitch_rate").values, rows.history[0]));
  CHECK(read_reasons(file) == rows.reason);
  const auto attempts = file.read_integers("/attempt");
  CHECK(std::equal(attempts.begin(), attempts.end(), rows.attempt.begin(), rows.attempt.end()));
  CHECK(file.read_label("/snapshot").names ==
        std::vector<std::string>{"pitch_angle", "body_position_z"});
  CHECK(file.read_attribute("/", "plan_hash") == std::string(64, 'a'));
  CHECK(file.read_attribute("/", "checksum") == calc_rows_digest(rows).text());
  CHECK(file.read_attribute("/", "strut_version") == "0.1.0");
}

TEST_CASE("A merged file has every case in the plan's order, with retries applied",
          "[io][property]") {
  const TemporaryFolder folder;
  const SweepFolder sweep = make_sweep(folder);
  const MergeReport report = merge(sweep, folder / "merged.h5");
  CHECK(report.cases == 3 * kCases);
  CHECK(report.shards == 3);
  CHECK(report.missing == 0);
  CHECK(report.failed == 3 * 6 - 2);
  CHECK(report.data_digest == calc_rows_digest(list_rows()).text());
  check_content(folder / "merged.h5", list_rows());
  const Hdf5Reader file(folder / "merged.h5");
  CHECK(file.read_integers("/shards/first_row") == std::vector<std::int64_t>{0, 20, 40});
  CHECK(file.read_integers("/shards/retries") == std::vector<std::int64_t>{0, 1, 0});
}

TEST_CASE("A merge refuses a missing shard, or with --partial leaves it out and reports it",
          "[io]") {
  const TemporaryFolder folder;
  const SweepFolder sweep = make_sweep(folder);
  fs::remove(sweep.shard(0));
  CHECK_THROWS_WITH(merge(sweep, folder / "merged.h5"),
                    Contains("1 of 3 shards are missing") && Contains("000000"));
  CHECK(folder.file_count() == 1);
  const MergeReport report = merge(sweep, folder / "merged.h5", true);
  CHECK(report.missing == 1);
  CHECK(report.cases == 2 * kCases);
  const Hdf5Reader file(folder / "merged.h5");
  CHECK(file.read_integers("/shards/number") == std::vector<std::int64_t>{1, 2});
  CHECK(file.read_integers("/shards/first_row") == std::vector<std::int64_t>{0, 20});
  CHECK(file.read_integers("/case_id").front() == 900);
  CHECK(file.read_integers("/case_id").size() == 2 * kCases);
}

TEST_CASE("A merge stops at a damaged or foreign shard and names it", "[io]") {
  const TemporaryFolder folder;
  const SweepFolder sweep = make_sweep(folder);
  auto image = read_bytes(sweep.shard(2));
  image.back() ^= std::byte{1};
  write_file(sweep.shard(2), image);
  CHECK_THROWS_WITH(merge(sweep, folder / "merged.h5"), Contains("000002.h5: damaged"));
  write_shard(sweep.shard(2), 1, make_rows(2));
  CHECK_THROWS_WITH(merge(sweep, folder / "merged.h5"), Contains("000002.h5: is shard 1"));
  write_shard(sweep.shard(2), 2, make_rows(2));
  write_shard(sweep.shard(3), 3, make_rows(3));
  CHECK_THROWS_WITH(merge(sweep, folder / "merged.h5"),
                    Contains("000003.h5: the plan has no shard 3"));
  fs::remove(sweep.shard(3));
  write_shard(sweep.shard(2), 2, make_rows(0));
  CHECK_THROWS_WITH(merge(sweep, folder / "merged.h5"), Contains("case 1000 is in two shards"));
  MergeInput other = make_input();
  other.extent.plan_hash = "b";
  const auto go_on = [](std::int64_t) { return true; };
  CHECK_THROWS_WITH(merge_sweep(sweep, other, folder / "merged.h5", {}, go_on),
                    Contains("000000.h5: belongs to another plan"));
  other = make_input();
  other.schema.snapshot.pop_back();
  CHECK_THROWS_WITH(merge_sweep(sweep, other, folder / "merged.h5", {}, go_on),
                    Contains("000000.h5: its columns differ from those of its plan"));
  CHECK(folder.file_count() == 1);
}

TEST_CASE("A merge that is stopped or meets a full disk leaves no file", "[io]") {
  const TemporaryFolder folder;
  const SweepFolder sweep = make_sweep(folder);
  const auto stop = [](std::int64_t) { return false; };
  CHECK(merge_sweep(sweep, make_input(), folder / "merged.h5", {}, stop).data_digest.empty());
  for (const rlim_t bytes : {100U, 2000U, 6000U, 10000U}) {
    CAPTURE(bytes);
    const test::LimitedFileSize limit(bytes);
    CHECK_THROWS_AS(merge(sweep, folder / "merged.h5"), EnvironmentError);
  }
  CHECK(folder.file_count() == 1);
}

template <class T>
void append(std::string& text, const std::vector<T>& values) {
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Everything that a reader can learn from a merged file.
std::string read_everything(const Hdf5Reader& file) {
  std::string all;
  for (const char* name : {"/case_id", "/layer", "/status", "/attempt", "/shards/first_row"}) {
    append(all, file.read_integers(name));
  }
  for (const char* name : {"/parameters", "/snapshot", "/event_time", "/failure_time",
                           "/history/pitch_rate", "/history/body_acceleration_z"}) {
    const Hdf5Dataset data = file.read(name);
    append(all, data.values);
    for (const std::string& text : data.label.names) all += text;
    for (const std::string& text : data.label.units) all += text;
    all += data.label.unit + data.label.description;
  }
  for (const std::string& text : file.read_texts("/reason")) all += text;
  for (const std::string& key : file.list_attributes("/")) {
    const bool is_text = key != "schema_version" && key != "history_interval";
    all += key + (is_text ? file.read_attribute("/", key) : "");
  }
  return all;
}

// Bypasses the seal, as other tools do: damage is found by HDF5's own checksums over its structures
// and zlib's over the chunks.
TEST_CASE("A flipped bit in a merged file is an HDF5 error or changes nothing", "[io][property]") {
  const TemporaryFolder folder;
  merge(make_sweep(folder), folder / "merged.h5");
  const std::vector<std::byte> good = read_bytes(folder / "merged.h5");
  const std::string truth = read_everything(Hdf5Reader("merged.h5", good));
  std::mt19937 random(1);
  int found = 0, wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> image = good;
    const std::size_t at = random() % image.size();
    image[at] ^= std::byte{1} << (random() % 8);
    CAPTURE(at);
    try {
      if (read_everything(Hdf5Reader("merged.h5", image)) != truth) ++wrong;
    } catch (const InputError&) {
      ++found;
    }
  }
  CHECK(wrong == 0);
  CHECK(found > 500);
}

template <class T>
void write_values(const fs::path& path, const std::vector<T>& values) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

// Writes files and their content for read_with_h5py.py.
TEST_CASE("Example files for other tools", "[.][example_files]") {
  const char* const name = std::getenv("STRUT_EXAMPLE_FOLDER");
  REQUIRE(name != nullptr);
  const fs::path folder = name;
  const SweepFolder sweep{folder / "sweep"};
  const ShardRows rows = make_example_rows(make_example_schema(), kCases, 1000);
  write_shard(sweep.shard(0), 0, rows);
  const MergeInput input = {{std::string(64, 'a'), 2000, kCases, kCases, {}},
                            make_example_schema()};
  const auto go_on = [](std::int64_t) { return true; };
  merge_sweep(sweep, input, folder / "merged.h5", {}, go_on);
  fs::copy_file(sweep.shard(0), folder / "shard.h5");
  write_values(folder / "case_id.bin", rows.case_id);
  write_values(folder / "parameters.bin", rows.parameters);
  write_values(folder / "snapshot.bin", rows.snapshot);
  write_values(folder / "layer.bin", rows.layer);
  write_values(folder / "status.bin", rows.status);
  write_values(folder / "event_time.bin", rows.event_time);
  write_values(folder / "failure_time.bin", rows.failure_time);
  write_values(folder / "history+pitch_rate.bin", rows.history[0]);
  write_values(folder / "history+body_acceleration_z.bin", rows.history[1]);
  std::ofstream reasons(folder / "reason.txt");
  for (const std::string& reason : rows.reason) reasons << reason << "\n";
}

TEST_CASE("Rows appended piece by piece form the dataset", "[io][property]") {
  const TemporaryFolder folder;
  std::vector<double> values(200000);  // two chunks of 1 MiB
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sqrt(static_cast<double>(i));
  Hdf5StreamWriter file(folder / "stream.h5", {kMergedSeal, {}});
  file.create("/group/x", Hdf5Type::kDouble, {values.size() / 2, 2}, {"m", "", {}});
  std::size_t first = 0;
  for (std::size_t count = 2; first < values.size(); first += count, count += 994) {
    count = std::min(count, values.size() - first);
    file.append("/group/x", std::as_bytes(std::span(values).subspan(first, count)));
  }
  CHECK_THROWS_AS(file.append("/group/x", std::vector<double>{1.0, 2.0}), std::logic_error);
  CHECK_THROWS_AS(file.append("/group/x", std::vector<double>{1.0}), std::logic_error);
  file.commit();
  const Hdf5Reader reader(folder / "stream.h5");
  CHECK(same_bits(reader.read("/group/x").values, values));
  const auto block = reader.read_rows("/group/x", 60000, 3);
  CHECK(block.shape == std::vector<std::size_t>{3, 2});
  CHECK(same_bits(block.values, {values.begin() + 120000, values.begin() + 120006}));
  CHECK_THROWS_WITH(reader.read_rows("/group/x", 99999, 2), Contains("100000 rows"));

  Hdf5StreamWriter lacking(folder / "lacking.h5", {kMergedSeal, {}});
  lacking.create("/x", Hdf5Type::kInt64, {2}, {});
  lacking.append("/x", std::vector<std::int64_t>{1});
  CHECK_THROWS_AS(lacking.commit(), std::logic_error);
}

}  // namespace
}  // namespace strut
