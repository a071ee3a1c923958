#include "train/model/model_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <random>

#include "base/error/input_error.h"
#include "io/file/file_bytes.h"
#include "io/format/hdf5.h"
#include "tests/support/example_shard.h"
#include "tests/support/flip_bits.h"
#include "tests/support/limited_file_size.h"
#include "tests/support/temporary_folder.h"
#include "train/model/checkpoint.h"
#include "train/network/network.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

TrainedModel make_model() {
  TrainedModel model;
  model.sizes = {2, 3, 1};
  model.weights = make_nguyen_widrow_weights(NetworkShape(model.sizes), {}, 1);
  model.inputs = {{"pitch_angle", "rad", "angle"}, {"body_position_z", "m", "height"}};
  model.targets = {{"front_stiffness", "N/m", "rate"}};
  model.input_map = Normalizer({0.1, 0.5}, {0.2, 0.75});
  model.target_map = Normalizer({35500.0}, {40000.0});
  model.ci95 = {12.5};
  model.plan_hash = std::string(64, 'a');
  model.samples = 2000;
  model.usable = 1990;
  model.skipped = 10;
  model.split = {0.6, 0.2, 77};
  model.options = {{"rule", "trainlm"}, {"epochs", "12"}};
  model.record = {{0, 1.0, 2.0, 3.0, 4.0}, {1, 0.1, std::nan(""), 0.3, 0.4}};
  model.stop = StopReason::kValidation;
  model.best_epoch = 1;
  model.best_validation = 0.2;
  model.seconds = 1.5;
  model.provenance = {{"commit", "abc"}};
  return model;
}

Checkpoint make_checkpoint() {
  Checkpoint checkpoint;
  checkpoint.started_with = {{"seed", "1"}, {"layers", "4, 27, 4"}};
  checkpoint.state.rows = 5;
  LevenbergMarquardtState& state = checkpoint.state.training;
  state.weights = {0.1, 0.2};
  state.best_weights = {0.3, 1.0 / 3.0};
  state.scale = {1.0, 1.0};
  state.epoch = 7;
  state.damping = 1e-5 / 3.0;
  state.growth = 4.0;
  state.validation = std::nan("");
  state.best_validation = 1e-7;
  state.best_epoch = 6;
  state.failures = 1;
  state.trials = 9;
  state.seconds = 0.7;
  state.stop = StopReason::kEpochs;
  checkpoint.record = {{0, 1.0, 2.0, 3.0, 4.0}};
  return checkpoint;
}

void check_same(const TrainedModel& a, const TrainedModel& b) {
  CHECK(a.sizes == b.sizes);
  CHECK(test::same_bits(a.weights, b.weights));
  CHECK(a.inputs == b.inputs);
  CHECK(a.targets == b.targets);
  CHECK(a.input_map.low() == b.input_map.low());
  CHECK(a.input_map.high() == b.input_map.high());
  CHECK(a.target_map.low() == b.target_map.low());
  CHECK(a.target_map.high() == b.target_map.high());
  CHECK(a.ci95 == b.ci95);
  CHECK(a.plan_hash == b.plan_hash);
  CHECK(a.samples == b.samples);
  CHECK(a.usable == b.usable);
  CHECK(a.skipped == b.skipped);
  CHECK(a.split.seed == b.split.seed);
  CHECK(a.split.train == b.split.train);
  CHECK(a.split.validate == b.split.validate);
  CHECK(a.options == b.options);
  CHECK(a.stop == b.stop);
  CHECK(a.best_epoch == b.best_epoch);
  CHECK(a.best_validation == b.best_validation);
  CHECK(a.seconds == b.seconds);
  REQUIRE(a.record.size() == b.record.size());
  for (std::size_t i = 0; i < a.record.size(); ++i) {
    const EpochRecord &x = a.record[i], &y = b.record[i];
    CHECK(x.epoch == y.epoch);
    CHECK(test::same_bits({x.loss, x.validation, x.gradient, x.damping},
                          {y.loss, y.validation, y.gradient, y.damping}));
  }
}

TEST_CASE("A model is read from its file as it was written", "[io]") {
  const TemporaryFolder folder;
  write_trained_model(folder / "model.h5", make_model());
  check_same(read_trained_model(folder / "model.h5"), make_model());
  const Hdf5Reader file(folder / "model.h5");
  CHECK(file.read_attribute("/", "stop_reason") == "validation failures");
  CHECK(file.read_attribute("/", "commit") == "abc");
  CHECK(file.read_label("/inputs").units == std::vector<std::string>{"rad", "m"});
}

TEST_CASE("A checkpoint is read bit for bit as it was written", "[io]") {
  const TemporaryFolder folder;
  const Checkpoint before = make_checkpoint();
  write_checkpoint(folder / "c.h5", before);
  const Checkpoint after = read_checkpoint(folder / "c.h5");
  const LevenbergMarquardtState &a = before.state.training, &b = after.state.training;
  CHECK(after.state.rows == 5);
  CHECK(test::same_bits(a.weights, b.weights));
  CHECK(test::same_bits(a.best_weights, b.best_weights));
  CHECK(test::same_bits(a.scale, b.scale));
  CHECK(test::same_bits({a.damping, a.growth, a.validation, a.best_validation, a.seconds},
                        {b.damping, b.growth, b.validation, b.best_validation, b.seconds}));
  CHECK(a.epoch == b.epoch);
  CHECK(a.best_epoch == b.best_epoch);
  CHECK(a.failures == b.failures);
  CHECK(a.trials == b.trials);
  CHECK(a.stop == b.stop);
  CHECK(after.started_with == before.started_with);
  CHECK(after.record.size() == 1);
  CHECK_NOTHROW(require_same_start("c.h5", after, before.started_with));
  CHECK_THROWS_WITH(
      require_same_start("c.h5", after, {{"seed", "2"}, {"layers", "4, 27, 4"}, {"rule", "x"}}),
      Contains("c.h5: a checkpoint of a different training:\n  seed: was 1, is 2\n  rule: was "
               "absent, is x"));
}

TEST_CASE("Other files and inconsistent models are refused", "[io]") {
  const TemporaryFolder folder;
  const fs::path file = folder / "m.h5";
  write_checkpoint(file, make_checkpoint());
  CHECK_THROWS_WITH(read_trained_model(file), Contains("m.h5: not a model file of strut"));
  write_trained_model(file, make_model());
  CHECK_THROWS_WITH(read_checkpoint(file), Contains("m.h5: not a checkpoint file of strut"));
  CHECK_THROWS_WITH(read_trained_model(folder.write("text.h5", "text")),
                    Contains("text.h5: damaged, or not a model file"));
  TrainedModel model = make_model();
  model.weights.pop_back();
  write_trained_model(file, model);
  CHECK_THROWS_WITH(read_trained_model(file), Contains("/weights: 12; the layers have 13"));
  model = make_model();
  model.weights[3] = std::nan("");
  write_trained_model(file, model);
  CHECK_THROWS_WITH(read_trained_model(file), Contains("/weights: must be finite"));
  model = make_model();
  model.target_map = Normalizer({1.0}, {1.0});
  write_trained_model(file, model);
  CHECK_THROWS_WITH(read_trained_model(file), Contains("/targets: bounds"));
  for (const std::vector<double>& ci95 :
       {std::vector<double>{}, std::vector<double>{-1.0}, std::vector<double>{std::nan("")}}) {
    model = make_model();
    model.ci95 = ci95;
    write_trained_model(file, model);
    CHECK_THROWS_WITH(read_trained_model(file),
                      Contains("/ci95: must have a width for each target"));
  }
  model = make_model();
  model.sizes = {1, 4, 1};
  write_trained_model(file, model);
  CHECK_THROWS_WITH(read_trained_model(file), Contains("/inputs, /targets"));
}

TEST_CASE("Every flipped bit of a model or a checkpoint is found", "[io][property]") {
  const TemporaryFolder folder;
  const fs::path model = folder / "m.h5", checkpoint = folder / "c.h5";
  write_trained_model(model, make_model());
  write_checkpoint(checkpoint, make_checkpoint());
  CHECK(test::count_missed_flips(
            model, [&] { read_trained_model(model); }, "`strut train`") == 0);
  CHECK(test::count_missed_flips(
            checkpoint, [&] { read_checkpoint(checkpoint); }, "without --resume") == 0);
}

/// Reduces a sealed file to its HDF5 content, as earlier versions wrote it.
void strip_seal(const fs::path& file) {
  const std::vector<std::byte> bytes = read_bytes(file);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data() + kSealBytes),
             static_cast<std::streamsize>(bytes.size() - kSealBytes));
}

TEST_CASE("A flipped bit in a model without a seal is an error or changes nothing",
          "[io][property]") {
  const TemporaryFolder folder;
  const TrainedModel truth = make_model();
  write_trained_model(folder / "m.h5", truth);
  strip_seal(folder / "m.h5");
  const std::vector<std::byte> good = read_bytes(folder / "m.h5");
  std::mt19937 random(1);
  int found = 0, wrong = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::byte> image = good;
    image[random() % image.size()] ^= std::byte{1} << (random() % 8);
    test::write_bytes(folder / "m.h5", image);
    try {
      const TrainedModel model = read_trained_model(folder / "m.h5");
      if (!test::same_bits(model.weights, truth.weights) || model.sizes != truth.sizes ||
          model.input_map.low() != truth.input_map.low() || model.inputs != truth.inputs ||
          model.split.seed != truth.split.seed || model.ci95 != truth.ci95 ||
          model.options != truth.options) {
        ++wrong;
      }
    } catch (const InputError&) {
      ++found;
    }
  }
  CHECK(wrong == 0);
  CHECK(found > 100);
}

TEST_CASE("The checksum of a model covers its intervals", "[io]") {
  const TemporaryFolder folder;
  const TrainedModel model = make_model();
  write_trained_model(folder / "m.h5", model);
  strip_seal(folder / "m.h5");
  const std::vector<std::byte> good = read_bytes(folder / "m.h5");
  const double number = model.ci95[0];
  const auto* const begin = reinterpret_cast<const std::byte*>(&number);
  std::vector<std::byte> image = good;
  const auto at = std::search(image.begin(), image.end(), begin, begin + sizeof number);
  REQUIRE(at != image.end());
  *at ^= std::byte{1};  // one ulp
  test::write_bytes(folder / "m.h5", image);
  CHECK_THROWS_WITH(read_trained_model(folder / "m.h5"), Contains("checksum"));
}

TEST_CASE("Writing a model to a full disk keeps the existing file", "[io]") {
  const TemporaryFolder folder;
  write_trained_model(folder / "m.h5", make_model());
  const auto before = read_bytes(folder / "m.h5");
  {
    const test::LimitedFileSize limit(1000);
    CHECK_THROWS_AS(write_trained_model(folder / "m.h5", make_model()), EnvironmentError);
  }
  CHECK(read_bytes(folder / "m.h5") == before);
  CHECK(folder.file_count() == 1);
}

}  // namespace
}  // namespace strut
