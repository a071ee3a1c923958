// Files that an earlier version wrote (tests/data/d0caeb7) are read, or refused with the remedy.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "tests/jobs/program_sweep.h"
#include "tests/jobs/run_program.h"
#include "tests/support/temporary_folder.h"
#include "train/model/checkpoint.h"
#include "train/model/model_file.h"
#include "train/network/kernel.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const std::string kEarlier = STRUT_SOURCE_DIR "/tests/data/d0caeb7/";
/// Digest of the whole sweep, by the version that planned it.
constexpr char kDigest[] = "fbefe3773dc07d55317815990be005de5c7a83c9ca0256e05f1e540fd95cb018";
constexpr char kTraining[] = " --hidden 3 --allow-few --seed 1 --epochs 20 --threads 1";

/// A copy to work in.
fs::path copy_earlier(const TemporaryFolder& folder, const std::string& name) {
  fs::copy(kEarlier + name, folder / name, fs::copy_options::recursive);
  return folder / name;
}

TEST_CASE("A half-done sweep of an earlier version is finished to the same digest", "[io]") {
  const TemporaryFolder folder;
  const fs::path sweep = copy_earlier(folder, "half_done");

  const Outcome before = test::run_sweep_command("status", sweep);
  CHECK(before.code == 1);
  CHECK_THAT(before.out, Contains("2 of 4"));
  // No resume mends one of the cases that fail.
  CHECK(test::run_sweep_command("run", sweep, "--isa baseline --threads 2").code == 1);
  const test::Verdict verdict = test::verify_by_program(sweep, "--sample 8");
  CHECK(verdict.code == 0);
  CHECK(verdict.ok);
  CHECK(verdict.digest == kDigest);
  CHECK(test::run_sweep_command("status", sweep).code == 1);
  CHECK_THAT(test::run_sweep_command("cancel", sweep).out, Contains("nothing to cancel"));
}

TEST_CASE("A network of an earlier version identifies, is judged and exported", "[io]") {
  const TemporaryFolder folder;
  const std::string model = kEarlier + "model.h5";
  const Outcome identified = run_program(
      "identify " + model +
      " --set body_position_z=0.55 --set body_velocity_z=0.02 --set body_acceleration_z=-0.3 "
      "--set pitch_angle=0.008 --extrapolate");
  CHECK_THAT(identified.out, Contains("front_stiffness"));
  CHECK(identified.code <= 1);

  const Outcome judged = run_program("evaluate " + model + " " + kEarlier + "merged.h5");
  CHECK(judged.code == 0);
  CHECK_THAT(judged.out, Contains("9 cases of the test part"));
  // As the earlier version printed it.
  CHECK_THAT(judged.out, Contains("528.8") && Contains("0.02858"));

  for (const char* name : {"model.onnx", "model.h"}) {
    CHECK(run_program("export " + model + " -o " + (folder / name).string()).code == 0);
    CHECK(fs::file_size(folder / name) > 0);
  }
  CHECK(read_trained_model(kEarlier + "window.h5").window.has_value());
}

TEST_CASE("A merged file of an earlier version trains a network", "[io]") {
  const TemporaryFolder folder;
  const std::string model = folder / "model.h5";
  const Outcome trained = run_program("train " + kEarlier + "merged.h5 -o " + model + kTraining);
  CHECK(trained.code == 0);
  CHECK_THAT(trained.out, Contains("39 cases trained, 8 validated, 9 tested"));
}

TEST_CASE("A checkpoint of an earlier version is resumed on its instruction set", "[io]") {
  const TemporaryFolder folder;
  const std::string kept = copy_earlier(folder, "checkpoint.h5").string();
  const Checkpoint checkpoint = read_checkpoint(kept);
  CHECK(checkpoint.state.training.epoch == 5);
  CHECK(checkpoint.state.training.weights.size() == 27);

  const std::string data = "train " + kEarlier + "merged.h5 -o ";
  const Outcome resumed = run_program(data + (folder / "resumed.h5").string() + kTraining +
                                      " --resume --checkpoint " + kept);
  if (std::string(list_train_kernels().front().isa) != "avx512") {
    CHECK(resumed.code == 2);
    CHECK_THAT(resumed.messages, Contains("instruction_set: was avx512"));
    return;
  }
  CHECK(resumed.code == 0);
  REQUIRE(run_program(data + (folder / "whole.h5").string() + kTraining).code == 0);
  CHECK(read_trained_model(folder / "resumed.h5").weights ==
        read_trained_model(folder / "whole.h5").weights);
}

TEST_CASE("A virtual merged file of an earlier version is refused with the remedy", "[io]") {
  // With all the shards that it views in their place.
  const TemporaryFolder folder;
  fs::rename(copy_earlier(folder, "half_done"), folder / "whole");
  REQUIRE(test::run_sweep_command("run", folder / "whole").code == 1);
  const std::string view = copy_earlier(folder, "virtual.h5").string();
  const std::string model = folder / "model.h5";
  const Outcome trained = run_program("train " + view + " -o " + model + kTraining);
  CHECK(trained.code == 2);
  CHECK_THAT(trained.messages, Contains("virtual.h5") && Contains("strut merge"));
  CHECK_FALSE(fs::exists(model));
}

TEST_CASE("The report of an earlier version's comparison is made again", "[io]") {
  const TemporaryFolder folder;
  const fs::path comparison = copy_earlier(folder, "comparison");
  const Outcome reported = run_program("report " + comparison.string());
  CHECK(reported.code == 0);
  const std::string page = test::read_text(comparison / "report.html");
  CHECK_THAT(page, Contains("Adequate: the calibrated model agrees"));
  CHECK_THAT(page, Contains("run_1_fit_states") && Contains("run_2_judge_time"));
}

}  // namespace
}  // namespace strut
