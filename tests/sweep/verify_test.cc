// Verification finds and names every fault of a sweep folder.
#include <catch2/catch.hpp>
#include <fstream>

#include "io/store/shard_layout.h"
#include "sweep/shard_store.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using test::PlannedSweep;
using test::SweepText;

void flip_byte(const fs::path& file, std::uintmax_t at) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(at));
  const int byte = stream.get();
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(byte ^ 0x10));
}

TEST_CASE("A valid sweep passes, and resimulated cases agree bit for bit", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  const VerifyReport report = sweep.verify(27);
  CHECK(report.ok());
  CHECK(report.cases == 27);
  CHECK(report.shards == 6);
  CHECK(report.resimulated == 27);
  CHECK(report.compared_by_tolerance == 0);
  CHECK(report.data_digest.size() == 64);
}

TEST_CASE("A flipped byte is found and its file named", "[unit][io]") {
  const PlannedSweep sweep;
  sweep.run();
  const fs::path file = sweep.folder().shard(2);
  const std::uintmax_t size = fs::file_size(file);
  // From the seal to the last byte.
  for (const std::uintmax_t at : {std::uintmax_t{3}, std::uintmax_t{500}, std::uintmax_t{512},
                                  size / 3, size / 2, 2 * size / 3, size - 1}) {
    flip_byte(file, at);
    const VerifyReport report = sweep.verify();
    INFO("byte " << at << " of " << size);
    CHECK(!report.ok());
    REQUIRE(report.damaged.size() == 1);
    CHECK_THAT(report.damaged[0], Contains("shards/000002.h5"));
    CHECK(report.missing == 5);
    flip_byte(file, at);
  }
  CHECK(sweep.verify().ok());
}

TEST_CASE("The cases of a missing shard are counted", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  fs::remove(sweep.folder().shard(5));
  const VerifyReport report = sweep.verify();
  CHECK(!report.ok());
  CHECK(report.missing == 2);
  CHECK(report.damaged.empty());
}

TEST_CASE("A shard under the name of another one is found", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  fs::copy_file(sweep.folder().shard(1), sweep.folder().shard(3),
                fs::copy_options::overwrite_existing);
  const VerifyReport report = sweep.verify();
  CHECK(report.missing == 5);
  CHECK(report.foreign == 5);
  REQUIRE(report.damaged.size() == 1);
  CHECK_THAT(report.damaged[0], Contains("000003.h5") && Contains("is shard 1"));
}

TEST_CASE("A shard of another plan is found", "[unit]") {
  const PlannedSweep sweep;
  SweepText text;
  text.integrate = "method = \"rk4\"\nstep = 1e-3\nclosure = \"table\"\n";
  const PlannedSweep other(text);
  sweep.run();
  other.run();
  fs::copy_file(other.folder().shard(0), sweep.folder().shard(0),
                fs::copy_options::overwrite_existing);
  const VerifyReport report = sweep.verify();
  CHECK(report.foreign == 5);
  CHECK(report.missing == 5);
  REQUIRE(report.damaged.size() == 1);
  CHECK_THAT(report.damaged[0], Contains("another plan"));
}

TEST_CASE("A shard beyond the plan and foreign files are found", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  fs::copy_file(sweep.folder().shard(0), sweep.folder().shard(77));
  std::ofstream(sweep.folder().shards() / "notes.txt") << "mine";
  const VerifyReport report = sweep.verify();
  CHECK(report.missing == 0);
  CHECK(report.foreign == 5);
  CHECK(report.damaged.size() == 2);
}

/// Writes `rows` as shard `number`, in a valid file.
void replace_shard(const PlannedSweep& sweep, std::int64_t number, const ShardRows& rows,
                   const std::string& isa = list_kernels().front().isa) {
  const CompressedShard data = compress_shard(sweep.plan().make_schema(), rows);
  ShardProvenance provenance;
  provenance.plan_hash = sweep.plan().hash();
  provenance.shard = number;
  provenance.texts = {{kInstructionSetKey, isa}};
  const std::vector<std::byte> image = make_shard_image(data, provenance);
  std::ofstream stream(sweep.folder().shard(number), std::ios::binary);
  stream.write(reinterpret_cast<const char*>(image.data()),
               static_cast<std::streamsize>(image.size()));
}

TEST_CASE("A shard that was replaced by a valid one with other data is found", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  ShardRows rows = read_shard(sweep.folder().shard(1)).rows;
  rows.snapshot[4] *= 1.0 + 1e-15;
  replace_shard(sweep, 1, rows);
  const VerifyReport by_journal = sweep.verify();
  REQUIRE(by_journal.damaged.size() == 1);
  CHECK_THAT(by_journal.damaged[0], Contains("000001.h5"));

  fs::remove(sweep.folder().journal());
  CHECK(sweep.verify().ok());
  const VerifyReport by_simulation = sweep.verify(27);
  CHECK(!by_simulation.ok());
  CHECK(by_simulation.differing ==
        std::vector<std::string>{"case " + std::to_string(rows.case_id[1])});
}

TEST_CASE("A shard of another instruction set is compared to 1e-9", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  fs::remove(sweep.folder().journal());
  const ShardRows sound = read_shard(sweep.folder().shard(1)).rows;
  for (const double change : {0.0, 1e-10, 1e-8, 1e-4}) {
    ShardRows rows = sound;
    double& value = rows.snapshot[4];
    value += change * std::max(1.0, std::abs(value));
    replace_shard(sweep, 1, rows, "of another machine");
    const VerifyReport report = sweep.verify(27);
    INFO(change);
    CHECK(report.compared_by_tolerance == 5);
    CHECK(report.differing.size() == (change > 1e-9 ? 1 : 0));
  }
}

TEST_CASE("A shard simulated again but not recorded in the journal is as valid as the first",
          "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  const std::string digest = sweep.verify().data_digest;
  replace_shard(sweep, 2, read_shard(sweep.folder().shard(2)).rows);
  const VerifyReport report = sweep.verify();
  CHECK(report.ok());
  CHECK(report.data_digest == digest);
}

TEST_CASE("Duplicate, foreign and changed cases are counted", "[unit]") {
  const PlannedSweep sweep;
  sweep.run();
  fs::remove(sweep.folder().journal());
  const ShardRows sound = read_shard(sweep.folder().shard(1)).rows;

  ShardRows rows = sound;
  rows.case_id[2] = rows.case_id[0];
  replace_shard(sweep, 1, rows);
  CHECK(sweep.verify().misplaced == 1);
  CHECK(sweep.verify().missing == 1);

  rows = sound;
  rows.case_id[2] = 999;
  replace_shard(sweep, 1, rows);
  CHECK(sweep.verify().foreign == 1);

  rows = sound;
  rows.parameters[0] += 1.0;
  replace_shard(sweep, 1, rows);
  CHECK(sweep.verify().foreign == 1);

  replace_shard(sweep, 1, sound);
  CHECK(sweep.verify().ok());
}

}  // namespace
}  // namespace strut
