// strut train and strut evaluate as a user meets them.
#include <catch2/catch.hpp>
#include <fstream>

#include "io/file/file_bytes.h"
#include "io/store/shard.h"
#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"
#include "tests/support/example_shard.h"
#include "train/model/model_file.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

std::string make_sweep_text(int seed) {
  const std::string examples = STRUT_SOURCE_DIR "/examples";
  return "vehicle = \"" + examples + "/vehicles/paper_sedan.toml\"\nmaneuver = \"" + examples +
         "/maneuvers/bump_20mps.toml\"\n" + R"(
[grid]
front_stiffness = { from = 40000, to = 35500 }
rear_stiffness  = { from = 35000, to = 30500 }
[sample]
method = "sobol"
strata = 1
count = 200
seed = )" +
         std::to_string(seed) +
         R"(
[integrate]
closure = "table"
step = 4e-3
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle"] }
[shards]
cases = 60
)";
}

/// A sweep that has run, made once: nothing here changes it.
const fs::path& get_sweep() {
  static const TemporaryFolder folder;
  static const fs::path sweep = [] {
    const std::string file = folder.write("sweep.toml", make_sweep_text(1)).string();
    fs::path made = folder / "sweep";
    REQUIRE(run_program("plan " + file + " -o " + made.string()).code == 0);
    REQUIRE(run_program("run " + made.string()).code == 0);
    return made;
  }();
  return sweep;
}

Outcome train(const std::string& data, const fs::path& output, const std::string& options = "") {
  return run_program("train " + data + " -o " + output.string() + " --hidden 6,4 --epochs 40 " +
                     options);
}

std::vector<double> train_weights(const std::string& data, const std::string& options = "") {
  const TemporaryFolder folder;
  const Outcome outcome = train(data, folder / "m.h5", options);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return read_trained_model(folder / "m.h5").weights;
}

TEST_CASE("A network learns the stiffness of both axles from a sweep's snapshots", "[io][slow]") {
  const TemporaryFolder folder;
  const Outcome outcome = train(get_sweep().string(), folder / "m.h5", "--json");
  REQUIRE(outcome.code == 0);
  const test::JsonTree trained = test::parse_json(outcome.out);
  // A hundredth of the range.
  CHECK(trained.get<double>("parameters.front_stiffness.MAE") < 45.0);
  CHECK(trained.get<double>("parameters.rear_stiffness.R2") > 0.99);
  CHECK(trained.get<int>("samples") == 30);
  CHECK(trained.get<int>("training_cases") == 140);

  const std::string model = (folder / "m.h5").string() + " " + get_sweep().string();
  const test::JsonTree test_part =
      test::parse_json(run_program("evaluate " + model + " --json").out);
  CHECK(test_part.get_child("parameters") == trained.get_child("parameters"));
  CHECK(test_part.get<int>("samples") == 30);
  const test::JsonTree all =
      test::parse_json(run_program("evaluate " + model + " --part all --json").out);
  CHECK(all.get<int>("samples") == 200);
  CHECK_THAT(run_program("evaluate " + model).out,
             Contains("30 cases of the test part") && Contains("rear_stiffness"));
}

TEST_CASE("Weights depend neither on how cases are stored nor on batches or threads",
          "[io][property][slow]") {
  const TemporaryFolder folder;
  const std::string sweep = get_sweep().string(), merged = folder / "all.h5";
  REQUIRE(run_program("merge " + sweep + " -o " + merged).code == 0);
  const std::vector<double> weights = train_weights(sweep, "--threads 1");
  CHECK(weights.size() == 5 * 6 + 7 * 4 + 5 * 2);
  CHECK(train_weights(sweep, "--threads 2") == weights);
  CHECK(train_weights(sweep, "--batch 1") == weights);
  CHECK(train_weights(sweep + "/shards/*.h5", "--batch 100") == weights);
  CHECK(train_weights(merged) == weights);
  CHECK(train_weights(sweep, "--seed 2") != weights);
  CHECK(train_weights(sweep, "--rule trainlm") != weights);
  const std::vector<double> grown = train_weights(sweep, "--growing --threads 1");
  CHECK(grown != weights);
  CHECK(train_weights(sweep, "--growing --threads 2 --batch 30") == grown);
  // The first samples are the first shards' rows.
  CHECK(train_weights(sweep + "/shards/000000.h5 " + sweep + "/shards/000001.h5") ==
        train_weights(sweep, "--samples 120"));
}

TEST_CASE("A resumed training is the uninterrupted one bit for bit", "[io][property][slow]") {
  const TemporaryFolder folder;
  const std::string sweep = get_sweep().string(), keep = (folder / "keep.h5").string();
  const std::string rule = GENERATE("--rule gain-ratio", "--rule trainlm", "--growing");
  const std::string common = " " + rule + " --max-failures 1000 ";
  REQUIRE(train(sweep, folder / "whole.h5", common).code == 0);
  const std::string begin = "train " + sweep + " --hidden 6,4" + common;
  REQUIRE(
      run_program(begin + "-o " + (folder / "a.h5").string() + " --epochs 4 --checkpoint " + keep)
          .code == 0);
  const std::string resume = " --resume --checkpoint " + keep;
  REQUIRE(train(sweep, folder / "b.h5", common + resume).code == 0);
  const TrainedModel whole = read_trained_model(folder / "whole.h5"),
                     parts = read_trained_model(folder / "b.h5");
  CHECK(parts.weights == whole.weights);
  CHECK(parts.best_validation == whole.best_validation);
  REQUIRE(parts.record.size() == whole.record.size());
  for (std::size_t i = 0; i < whole.record.size(); ++i) {
    CHECK(parts.record[i].epoch == whole.record[i].epoch);
    CHECK(parts.record[i].loss == whole.record[i].loss);
    CHECK(parts.record[i].damping == whole.record[i].damping);
  }
  const Outcome other = train(sweep, folder / "c.h5", common + resume + " --seed 5");
  CHECK(other.code == 2);
  CHECK_THAT(other.messages, Contains("seed: was 1, is 5"));
  const Outcome exists = train(sweep, folder / "c.h5", "--checkpoint " + keep);
  CHECK(exists.code == 2);
  CHECK_THAT(exists.messages, Contains("exists; --resume"));
  CHECK(!fs::exists(folder / "c.h5"));
}

/// Refused with these texts, and no model written.
void check_refused(const std::string& data, const std::string& options,
                   const std::vector<std::string>& texts) {
  const TemporaryFolder folder;
  const Outcome outcome = train(data, folder / "m.h5", options);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(folder.file_count() == 0);
  for (const std::string& text : texts) CHECK_THAT(outcome.messages, Contains(text));
}

TEST_CASE("Training refuses what it cannot learn from", "[io]") {
  const std::string sweep = get_sweep().string();
  check_refused(sweep, "--inputs body_position_z,pitch_angel",
                {"'pitch_angel'", "did you mean 'pitch_angle'?", "body_velocity_z"});
  check_refused(sweep, "--samples 9999", {"200 usable cases", "asked for 9999"});
  check_refused(sweep, "--samples 40",
                {"28 training cases x 2 parameters give 56", "68 weights", "--allow-few"});
  check_refused(sweep, "--samples 2", {"too few"});
  check_refused(sweep, "--rule newton", {"--rule = newton", "trainlm"});
  check_refused("/nowhere", "", {"/nowhere: not found"});
  check_refused("", "", {"DATA: missing"});
  CHECK(train_weights(sweep, "--samples 40 --allow-few").size() == 68);
}

TEST_CASE("Training names a constant input, a shard of another plan and missing shards", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = get_sweep().string();
  Shard shard = read_shard(sweep + "/shards/000000.h5");
  for (std::size_t row = 0; row < shard.rows.size(); ++row) shard.rows.snapshot[4 * row + 1] = 0.5;
  const auto write = [&](const std::string& name) {
    const auto image = make_shard_image(compress_shard(shard.schema, shard.rows), shard.provenance);
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()),
               static_cast<std::streamsize>(image.size()));
    return (folder / name).string();
  };
  check_refused(write("flat.h5"), "", {"input 'body_velocity_z' is constant", "0.5"});
  shard.provenance.plan_hash = std::string(64, 'b');
  check_refused(sweep + "/shards/000001.h5 " + write("foreign.h5"), "",
                {"foreign.h5: belongs to plan", "bbbb"});
  fs::copy(sweep, folder / "lacking", fs::copy_options::recursive);
  fs::remove(folder / "lacking/shards/000002.h5");
  check_refused(folder / "lacking", "", {"60 of 200 cases are missing", "--partial"});
  CHECK(train_weights(folder / "lacking", "--partial").size() == 68);
}

TEST_CASE("Cases with NaN are left out of a training and counted", "[io][threads]") {
  const TemporaryFolder folder;
  Shard shard = read_shard(get_sweep().string() + "/shards/000000.h5");
  shard.rows.snapshot[4 * 10] = std::nan("");
  shard.rows.status[20] = 1;
  const auto image = make_shard_image(compress_shard(shard.schema, shard.rows), shard.provenance);
  std::ofstream(folder / "s.h5", std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  const Outcome good = run_program("train " + (folder / "s.h5").string() +
                                   " --hidden 4 --json -o " + (folder / "m.h5").string());
  REQUIRE(good.code == 0);
  CHECK(test::parse_json(good.out).get<int>("skipped_cases") == 2);
  CHECK(read_trained_model(folder / "m.h5").usable == 58);
}

TEST_CASE("Nothing is overwritten without --force", "[io]") {
  const TemporaryFolder folder;
  const fs::path model = folder.write("m.h5", "mine");
  const Outcome refused = train(get_sweep().string(), model);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.messages, Contains("m.h5: exists; --force replaces it"));
  CHECK(test::read_text(model) == "mine");
  CHECK(train(get_sweep().string(), model, "--force").code == 0);
  CHECK(read_trained_model(model).sizes == std::vector<int>{4, 6, 4, 2});
  const fs::path shard = get_sweep() / "shards/000000.h5";
  const auto before = read_bytes(shard);
  CHECK_THAT(train(shard, shard, "--force").messages, Contains("part of the sweep in"));
  CHECK_THAT(train(shard, folder / "n.h5", "--force --checkpoint " + shard.string()).messages,
             Contains("part of the sweep in"));
  const fs::path copy = folder / "copy.h5";
  fs::copy_file(shard, copy);
  CHECK_THAT(train(copy, copy, "--force").messages, Contains("is an input of this command"));
  CHECK_THAT(train(copy, folder / "n.h5", "--force --checkpoint " + copy.string()).messages,
             Contains("is an input of this command"));
  CHECK_THAT(train(copy, folder / "n.h5", "--checkpoint " + (folder / "n.h5").string()).messages,
             Contains("is the model of --output"));
  CHECK(read_bytes(shard) == before);
}

TEST_CASE("Each limit of a training is an option that stops it", "[io]") {
  struct Limit {
    const char *option, *reason;
  };
  const Limit limits[] = {{"--goal 1e9", "goal"},
                          {"--min-gradient 1e9", "gradient"},
                          {"--max-damping 1e-30", "damping bound"},
                          {"--max-time 1e-9", "time"}};
  for (const Limit& limit : limits) {
    const TemporaryFolder folder;
    const Outcome outcome =
        train(get_sweep().string(), folder / "m.h5", std::string("--json ") + limit.option);
    REQUIRE(outcome.code == 0);
    CHECK(test::parse_json(outcome.out).get<std::string>("stopped_by") == limit.reason);
  }
  CHECK(train_weights(get_sweep(), "--damping 10") != train_weights(get_sweep()));
}

TEST_CASE("A place where nothing can be written is told", "[io]") {
  const TemporaryFolder folder;
  const std::string sweep = get_sweep().string(), none = (folder / "none/c.h5").string();
  const Outcome model = train(sweep, none);
  CHECK(model.code == 3);
  CHECK_THAT(model.messages, Contains("there is no folder") && Contains("none"));
  const Outcome state = train(sweep, folder / "m.h5", "--checkpoint " + none);
  CHECK(state.code == 3);
  CHECK_THAT(state.messages, Contains("c.h5"));
  CHECK(folder.file_count() == 0);
}

TEST_CASE("A test part is told only of the data that trained", "[io]") {
  const TemporaryFolder folder;
  const std::string model = (folder / "m.h5").string();
  REQUIRE(train(get_sweep().string(), model).code == 0);
  const std::string toml = folder.write("other.toml", make_sweep_text(2)).string();
  const std::string other = (folder / "other").string();
  REQUIRE(run_program("plan " + toml + " -o " + other).code == 0);
  REQUIRE(run_program("run " + other).code == 0);
  const Outcome all = run_program("evaluate " + model + " " + other + " --json");
  REQUIRE(all.code == 0);
  CHECK(test::parse_json(all.out).get<int>("samples") == 200);
  const Outcome part = run_program("evaluate " + model + " " + other + " --part test");
  CHECK(part.code == 2);
  CHECK_THAT(part.messages, Contains("another plan") && Contains("--part all"));
  const Outcome fewer =
      run_program("evaluate " + model + " " + get_sweep().string() + "/shards/000000.h5");
  CHECK(fewer.code == 2);
  CHECK_THAT(fewer.messages, Contains("200 usable cases, these have 60"));
  CHECK(run_program("evaluate " + model).code == 2);
  const Outcome model_twice = run_program("evaluate " + model + " " + model);
  CHECK(model_twice.code == 2);
  CHECK_THAT(model_twice.messages, Contains("a model file of strut; must be"));
  const Outcome turned = run_program("evaluate " + get_sweep().string() + " " + model);
  CHECK(turned.code == 2);
  CHECK_THAT(turned.messages, Contains("a folder; must be a regular file"));
}

}  // namespace
}  // namespace strut
