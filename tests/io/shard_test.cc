#include "io/store/shard.h"

#include <bit>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "io/file/file_bytes.h"
#include "tests/support/example_shard.h"
#include "tests/support/temporary_folder.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_example_image;
using test::make_example_provenance;
using test::make_example_rows;
using test::make_example_schema;
using test::same_bits;
using test::TemporaryFolder;
namespace fs = std::filesystem;

fs::path write_image(const TemporaryFolder& folder, std::span<const std::byte> image) {
  return folder.write("shard.h5",
                      std::string(reinterpret_cast<const char*>(image.data()), image.size()));
}

void check_same_rows(const ShardRows& a, const ShardRows& b) {
  CHECK(a.case_id == b.case_id);
  CHECK(same_bits(a.parameters, b.parameters));
  CHECK(same_bits(a.snapshot, b.snapshot));
  CHECK(a.layer == b.layer);
  CHECK(a.status == b.status);
  CHECK(a.attempt == b.attempt);
  CHECK(same_bits(a.event_time, b.event_time));
  CHECK(same_bits(a.failure_time, b.failure_time));
  CHECK(a.reason == b.reason);
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t c = 0; c < a.history.size(); ++c) CHECK(same_bits(a.history[c], b.history[c]));
}

TEST_CASE("A shard reads back bit for bit", "[io][property]") {
  const TemporaryFolder folder;
  const ShardSchema schema = make_example_schema();
  const ShardRows rows = make_example_rows(schema, 20);
  const fs::path path = write_image(folder, make_example_image(20));
  const Shard shard = read_shard(path);
  check_same_rows(shard.rows, rows);
  REQUIRE(shard.schema.history.size() == 2);
  CHECK(shard.schema.history[0].name == "pitch_rate");
  CHECK(shard.schema.history[1].unit == "m/s^2");
  CHECK(shard.schema.history_samples == 3);
  CHECK(shard.schema.history_interval == 0.005);
  CHECK(shard.schema.status_meaning == schema.status_meaning);
  REQUIRE(shard.schema.snapshot.size() == 2);
  CHECK(shard.schema.parameters[1].name == "front_damping");
  CHECK(shard.schema.parameters[1].unit == "N s/m");
  CHECK(shard.schema.snapshot[0].description == "angle");
  CHECK(shard.provenance.plan_hash == std::string(64, 'a'));
  CHECK(shard.provenance.shard == 7);
  CHECK(shard.provenance.texts == make_example_provenance().texts);
  const ShardSeal seal = read_shard_seal(path);
  CHECK(seal.shard == 7);
  CHECK(seal.size == fs::file_size(path));
  CHECK(seal.plan_hash == shard.provenance.plan_hash);
  CHECK(check_shard_bytes(path).sha256 == seal.sha256);
}

TEST_CASE("A shard without snapshots and histories reads back", "[io]") {
  const TemporaryFolder folder;
  ShardSchema schema = make_example_schema();
  schema.snapshot.clear();
  schema.history.clear();
  const ShardRows rows = make_example_rows(schema, 1);
  const Shard shard = read_shard(write_image(
      folder, make_shard_image(compress_shard(schema, rows), make_example_provenance())));
  check_same_rows(shard.rows, rows);
  CHECK(shard.schema.snapshot.empty());
  CHECK(shard.schema.history.empty());
}

TEST_CASE("A shard of many chunks reads back bit for bit", "[io][property]") {
  const TemporaryFolder folder;
  ShardSchema schema = make_example_schema();
  schema.history_samples = 700;  // 1000 rows: 5.6 MB a channel
  const ShardRows rows = make_example_rows(schema, 1000);
  const CompressedShard compressed = compress_shard(schema, rows);
  CHECK(compressed.datasets.back().chunks.size() == 6);
  for (const Hdf5Chunks& d : compressed.datasets) {
    CHECK(d.chunk_rows * (d.shape.size() > 1 ? d.shape[1] : 1) * 8 <= (1U << 20));
  }
  const fs::path path =
      write_image(folder, make_shard_image(compressed, make_example_provenance()));
  check_same_rows(read_shard(path).rows, rows);
  const Hdf5Reader file(path);
  const std::size_t step = file.read_chunk_rows("/history/pitch_rate");
  CHECK(step == compressed.datasets.back().chunk_rows);
  std::vector<double> pieces;
  for (std::size_t first = 0; first < 1000; first += step) {
    const auto block = file.read_rows("/history/pitch_rate", first, std::min(step, 1000 - first));
    CHECK(block.shape.back() == 700);
    pieces.insert(pieces.end(), block.values.begin(), block.values.end());
  }
  CHECK(same_bits(pieces, rows.history[0]));
}

TEST_CASE("Equal shards have equal bytes", "[io][property]") {
  CHECK(make_example_image(20) == make_example_image(20));
}

TEST_CASE("Every flipped byte of a shard is found", "[io][property]") {
  const TemporaryFolder folder;
  std::vector<std::byte> image = make_example_image(4);
  CHECK_NOTHROW(check_shard_bytes("shard.h5", image));
  std::size_t missed = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::byte flip = std::byte{1} << (i % 8);
    image[i] ^= flip;
    try {
      check_shard_bytes("shard.h5", image);
      ++missed;
    } catch (const InputError& e) {
      if (std::string(e.what()).find("shard.h5: damaged") != 0) ++missed;
    }
    image[i] ^= flip;
  }
  CHECK(missed == 0);
}

TEST_CASE("Every truncation of a shard is found by its seal", "[io][property]") {
  const TemporaryFolder folder;
  const std::vector<std::byte> image = make_example_image(2);
  const fs::path path = write_image(folder, image);
  std::size_t missed = 0;
  for (std::size_t size = image.size(); size-- > 0;) {
    fs::resize_file(path, size);
    try {
      read_shard_seal(path);
      ++missed;
    } catch (const InputError&) {
    }
  }
  CHECK(missed == 0);
  CHECK_THROWS_AS(check_shard_bytes(path), InputError);
  CHECK_THROWS_WITH(check_shard_bytes(folder / "no.h5"), Contains("no.h5: file not found"));
}

TEST_CASE("A file that is not a shard is not read, however large", "[io]") {
  const TemporaryFolder folder;
  const fs::path path = folder.write("shard.h5", "no shard");
  fs::resize_file(path, std::uintmax_t{1} << 42);  // sparse; larger than any memory
  CHECK_THROWS_WITH(check_shard_bytes(path), Contains("shard.h5: damaged, or not a shard"));
  CHECK_THROWS_WITH(read_shard(path), Contains("shard.h5: damaged, or not a shard"));
}

TEST_CASE("The bytes after the user block have the SHA-256 of the seal", "[io][reference]") {
  const TemporaryFolder folder;
  const fs::path path = write_image(folder, make_example_image(4));
  const std::string text = test::read_text(path);
  CHECK_THAT(text.substr(0, 512), Contains("sha256 " + to_hex(calc_sha256(text.substr(512)))) &&
                                      Contains("size " + std::to_string(text.size()) + "\n") &&
                                      Contains("plan " + std::string(64, 'a') + "\n") &&
                                      Contains("shard 7\n"));
}

TEST_CASE("A row's hash changes with every number and with no other row", "[unit][property]") {
  const ShardSchema schema = make_example_schema();
  const ShardRows rows = make_example_rows(schema, 3);
  const auto flip = [](double& x) {
    x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ 1U);
  };
  const std::vector<void (*)(ShardRows&, std::size_t)> changes = {
      [](ShardRows& r, std::size_t i) { ++r.case_id[i]; },
      [](ShardRows& r, std::size_t i) { ++r.layer[i]; },
      [](ShardRows& r, std::size_t i) { ++r.status[i]; },
      [](ShardRows& r, std::size_t i) { ++r.attempt[i]; },
      [](ShardRows& r, std::size_t i) { r.event_time[i] = 3.0; },
      [](ShardRows& r, std::size_t i) { r.failure_time[i] = 3.0; }};
  for (const auto change : changes) {
    ShardRows changed = rows;
    change(changed, 1);
    CHECK(calc_row_hash(changed, 1) != calc_row_hash(rows, 1));
    CHECK(calc_row_hash(changed, 0) == calc_row_hash(rows, 0));
  }
  const auto check_array = [&](auto get) {
    for (std::size_t i = 0; i < get(rows).size(); ++i) {
      ShardRows changed = rows;
      flip(get(changed)[i]);
      const std::size_t row = i / (get(rows).size() / 3);
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK((calc_row_hash(changed, k) == calc_row_hash(rows, k)) == (k != row));
      }
    }
  };
  check_array([](auto& r) -> auto& { return r.parameters; });
  check_array([](auto& r) -> auto& { return r.snapshot; });
  check_array([](auto& r) -> auto& { return r.history[1]; });
}

TEST_CASE("All NaNs give the same row hash, zeros of both signs do not", "[unit]") {
  const ShardSchema schema = make_example_schema();
  ShardRows rows = make_example_rows(schema, 1);
  rows.snapshot[0] = std::numeric_limits<double>::quiet_NaN();
  const Hash hash = calc_row_hash(rows, 0);
  for (const std::uint64_t bits : {0xfff8000000000000U, 0x7ff8000000000123U, 0xfff0000000000001U}) {
    rows.snapshot[0] = std::bit_cast<double>(bits);
    CHECK(calc_row_hash(rows, 0) == hash);
  }
  rows.snapshot[0] = 0.0;
  const Hash zero = calc_row_hash(rows, 0);
  rows.snapshot[0] = -0.0;
  CHECK(calc_row_hash(rows, 0) != zero);
}

TEST_CASE("A row's hash is SHA-256 over its little-endian bytes", "[unit][reference]") {
  ShardSchema schema;
  schema.parameters = {{"a", "1", ""}};
  schema.snapshot = {{"b", "1", ""}};
  ShardRows rows = ShardRows::make(schema, 1);
  rows.case_id[0] = 258;
  rows.parameters[0] = 1.0;
  rows.layer[0] = 1;
  rows.status[0] = 2;
  rows.attempt[0] = 3;
  rows.event_time[0] = 2.0;
  using namespace std::string_literals;
  const std::string nan = "\0\0\0\0\0\0\xf8\x7f"s;
  CHECK(calc_row_hash(rows, 0) ==
        calc_sha256("\x02\x01\0\0\0\0\0\0"s + "\0\0\0\0\0\0\xf0\x3f"s + nan + "\1\0\0\0"s +
                    "\2\0\0\0"s + "\3\0\0\0"s + "\0\0\0\0\0\0\0\x40"s + nan));
}

TEST_CASE("Rows copied one by one are the same rows", "[unit][property]") {
  const ShardSchema schema = make_example_schema();
  const ShardRows rows = make_example_rows(schema, 5);
  ShardRows copy = ShardRows::make(schema, 5);
  for (const std::size_t i : {4U, 0U, 2U, 3U, 1U}) copy.set_row(i, rows, i);
  check_same_rows(copy, rows);
  CHECK(calc_rows_digest(copy) == calc_rows_digest(rows));
}

TEST_CASE("Rows that do not match the schema are refused", "[unit]") {
  const ShardSchema schema = make_example_schema();
  ShardRows rows = make_example_rows(schema, 5);
  rows.snapshot.pop_back();
  CHECK_THROWS_AS(compress_shard(schema, rows), std::logic_error);
  rows = make_example_rows(schema, 5);
  rows.history.pop_back();
  CHECK_THROWS_AS(compress_shard(schema, rows), std::logic_error);
}

/// Writes `shard` to a sealed file with another schema version.
fs::path write_changed(const TemporaryFolder& folder, const CompressedShard& shard,
                       int schema_version) {
  Hdf5Writer file(Hdf5InMemory{"changed"}, {.seal = make_shard_label("p", 7)});
  for (const Hdf5Chunks& dataset : shard.datasets) file.write_chunks(dataset);
  file.write_attribute("/", "schema_version", std::int64_t{schema_version});
  file.write_attribute("/", "plan_hash", "p");
  file.write_attribute("/", "shard", std::int64_t{7});
  file.write_attribute("/", "checksum", shard.digest.text());
  file.write_attribute("/", "status_meaning", "");
  file.write_attribute("/", "history_interval", 0.0);
  return write_image(folder, file.image());
}

TEST_CASE("A shard with another schema version or shape is refused with a message that names it",
          "[io]") {
  const TemporaryFolder folder;
  ShardSchema schema = make_example_schema();
  schema.history.clear();
  const CompressedShard shard = compress_shard(schema, make_example_rows(schema, 4));
  CHECK_NOTHROW(read_shard(write_changed(folder, shard, 1)));
  CHECK_THROWS_WITH(read_shard(write_changed(folder, shard, 2)),
                    Contains("shard.h5: schema_version: is 2") && Contains("newer"));
  CHECK_THROWS_WITH(read_shard(write_changed(folder, shard, 0)), Contains("schema_version"));

  for (std::size_t i = 0; i < shard.datasets.size(); ++i) {
    CompressedShard without = shard;
    const std::string name = shard.datasets[i].name;
    without.datasets.erase(without.datasets.begin() + static_cast<std::ptrdiff_t>(i));
    CAPTURE(name);
    if (name == "/snapshot") {
      CHECK_THROWS_WITH(read_shard(write_changed(folder, without, 1)), Contains("checksum"));
    } else {
      CHECK_THROWS_WITH(read_shard(write_changed(folder, without, 1)),
                        Contains("shard.h5: " + name));
    }
  }
  const CompressedShard longer = compress_shard(schema, make_example_rows(schema, 5));
  for (std::size_t i = 1; i < shard.datasets.size(); ++i) {
    CompressedShard mixed = shard;
    mixed.datasets[i] = longer.datasets[i];
    CHECK_THROWS_WITH(
        read_shard(write_changed(folder, mixed, 1)),
        Contains("shard.h5: " + shard.datasets[i].name) && Contains("must have 4 rows"));
  }
  CompressedShard other = shard;
  other.digest.add(calc_sha256("x"));
  CHECK_THROWS_WITH(read_shard(write_changed(folder, other, 1)), Contains("checksum"));
}

TEST_CASE("A data digest counts its rows", "[unit]") {
  DataDigest once, twice;
  const Hash row = calc_sha256("x");
  once.add(row);
  twice.add(row);
  twice.add(Hash{});  // adds nothing to the sums
  CHECK(once.text() != twice.text());
  CHECK(DataDigest().text() != once.text());
}

TEST_CASE("A damaged shard never reaches the HDF5 library", "[io][property]") {
  const TemporaryFolder folder;
  const std::vector<std::byte> good = make_example_image(4);
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> image = good;
    image[random() % image.size()] ^= std::byte{1} << (random() % 8);
    CHECK_THROWS_WITH(read_shard(write_image(folder, image)), Contains("shard.h5: damaged"));
  }
}

TEST_CASE("HDF5 content that was damaged before it was sealed is found", "[io][property]") {
  const TemporaryFolder folder;
  const std::vector<std::byte> good = make_example_image(4);
  const ShardRows rows = read_shard(write_image(folder, good)).rows;
  std::mt19937 random(1);
  int found = 0, harmless = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::byte> image = good;
    const std::size_t at = 512 + random() % (image.size() - 512);
    image[at] ^= std::byte{1} << (random() % 8);
    seal_image(make_shard_label(std::string(64, 'a'), 7), image);
    try {
      check_same_rows(read_shard(write_image(folder, image)).rows, rows);
      ++harmless;
    } catch (const InputError&) {
      ++found;
    }
  }
  CHECK(found > harmless);
}

}  // namespace
}  // namespace strut
