// Files without a seal, as the version of tests/data/d0caeb7 wrote them: what is noted, and what
// their own checks find.
#include <algorithm>
#include <catch2/catch.hpp>

#include "io/store/dataset.h"
#include "sweep/plan_file.h"
#include "tests/jobs/run_program.h"
#include "tests/support/flip_bits.h"
#include "train/model/checkpoint.h"
#include "train/model/model_file.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const fs::path kFiles = STRUT_SOURCE_DIR "/tests/data/d0caeb7";

std::size_t count_notes(const Outcome& outcome) {
  const std::string note = "has no seal";
  std::size_t count = 0;
  for (std::size_t at = 0; (at = outcome.messages.find(note, at)) != std::string::npos; ++at) {
    ++count;
  }
  return count;
}

TEST_CASE("A plan without a seal is noted, and sealed by planning it again", "[io]") {
  const TemporaryFolder folder;
  fs::copy(kFiles / "half_done", folder / "sweep", fs::copy_options::recursive);
  const std::string sweep = (folder / "sweep").string();
  Outcome outcome = run_program("run " + sweep);
  INFO(outcome.messages);
  CHECK(outcome.code == 1);  // some of its cases fail
  CHECK(count_notes(outcome) == 1);
  CHECK_THAT(outcome.messages, Contains("sweep/plan.h5: has no seal") &&
                                   Contains("`strut plan DIR/request.toml -o DIR` seals it"));

  CHECK(run_program("plan " + sweep + "/request.toml -o " + sweep).code == 0);
  outcome = run_program("verify " + sweep);
  CHECK(outcome.code == 0);
  CHECK(count_notes(outcome) == 0);
}

TEST_CASE("A merged file and a model without seals are read, and a note says so once", "[io]") {
  const TemporaryFolder folder;
  const std::string merged = kFiles / "merged.h5", model = kFiles / "model.h5";
  Outcome outcome = run_program("train " + merged + " -o " + (folder / "m.h5").string() +
                                " --hidden 3 --epochs 3 --allow-few");
  INFO(outcome.messages);
  CHECK(outcome.code == 0);
  CHECK(count_notes(outcome) == 1);
  CHECK_THAT(outcome.messages,
             Contains("merged.h5: has no seal") && Contains("`strut merge DIR -o FILE --force`"));
  outcome = run_program("evaluate " + model + " " + merged);
  CHECK(outcome.code == 0);
  CHECK(count_notes(outcome) == 2);
  CHECK(count_notes(run_program("evaluate " + (folder / "m.h5").string() + " " + merged)) == 1);
  CHECK(count_notes(run_program("evaluate --quiet " + model + " " + merged)) == 0);
}

TEST_CASE("A view over shards is refused by name, and damaged is no crash", "[io]") {
  const TemporaryFolder folder;
  const fs::path file = folder / "virtual.h5";
  fs::copy_file(kFiles / "virtual.h5", file);
  CHECK_THROWS_WITH(
      Dataset({file}),
      Contains("virtual.h5: a view over shards cannot be verified; `strut merge DIR -o "
               "FILE` writes a copy"));
  // Some of these, met by the HDF5 library, end the process.
  const std::vector<std::byte> good = read_bytes(file);
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> image = good;
    image[random() % image.size()] ^= std::byte{1} << (random() % 8);
    test::write_bytes(file, image);
    REQUIRE_THROWS_AS(Dataset({file}), InputError);
  }
}

TEST_CASE("A flipped number in a merged file without a seal is found", "[io][property]") {
  const TemporaryFolder folder;
  const fs::path file = folder / "merged.h5";
  fs::copy_file(kFiles / "merged.h5", file);
  Dataset truth({kFiles / "merged.h5"});
  const ShardRows rows = truth.read(0, 64);
  std::mt19937 random(1);
  const std::vector<std::byte> good = read_bytes(file);
  int found = 0, wrong = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<std::byte> image = good;
    image[random() % image.size()] ^= std::byte{1} << (random() % 8);
    test::write_bytes(file, image);
    try {
      Dataset dataset({file});
      wrong += calc_rows_digest(dataset.read(0, 64)) == calc_rows_digest(rows) ? 0 : 1;
    } catch (const InputError&) {
      ++found;
    }
  }
  CHECK(wrong == 0);
  CHECK(found > 100);
}

TEST_CASE("A plan, a model and a checkpoint without seals hold to their own checks", "[io]") {
  CHECK(read_plan(kFiles / "half_done/plan.h5").extent.shard_cases == 16);
  CHECK(read_plan(kFiles / "half_done/plan.h5").extent.shard_count() == 4);
  CHECK(read_trained_model(kFiles / "model.h5").sizes == std::vector<int>{4, 3, 3});
  CHECK(read_checkpoint(kFiles / "checkpoint.h5").state.training.epoch == 5);

  const TemporaryFolder folder;
  const fs::path file = folder / "model.h5";
  std::vector<std::byte> image = read_bytes(kFiles / "model.h5");
  // Layer sizes as they lie in the file; a bit in the upper half of the first.
  const std::vector<std::int64_t> sizes = {4, 3, 3};
  const auto bytes = std::as_bytes(std::span(sizes));
  const auto at = std::search(image.begin(), image.end(), bytes.begin(), bytes.end());
  REQUIRE(at != image.end());
  *(at + 5) ^= std::byte{1};
  test::write_bytes(file, image);
  CHECK_THROWS_WITH(read_trained_model(file), Contains("model.h5: /layer_sizes: damaged"));
}

}  // namespace
}  // namespace strut
