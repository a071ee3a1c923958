// Networks over windows and with noise, as a user meets them.
#include <catch2/catch.hpp>
#include <fstream>

#include "io/csv.h"
#include "tests/parse_json.h"
#include "tests/run_program.h"
#include "train/model_file.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

const std::string kExamples = STRUT_SOURCE_DIR "/examples";
/// The car and the bump of the sweep, whose runs are shorter.
const std::string kCar = kExamples + "/vehicles/paper_sedan.toml";
const std::string kBump = kExamples + "/maneuvers/bump_20mps.toml";

std::string make_sweep_text(const fs::path& maneuver, int count) {
  return "vehicle = \"" + kCar + "\"\nmaneuver = \"" + maneuver.string() + "\"\n" + R"(
[grid]
front_stiffness = { from = 40000, to = 35500 }
rear_damping    = { from = 1980,  to = 1800 }
speed           = { from = 19.5,  to = 20.5 }
[sample]
method = "sobol"
strata = 1
count = )" +
         std::to_string(count) +
         R"(
[integrate]
closure = "table"
step = 1e-3
[record]
snapshot = { when = "rear_wheels_on_bump", channels = ["body_position_z", "body_velocity_z", "pitch_angle"] }
history = { rate = 500, channels = ["imu_acceleration_z", "imu_rate_y"] }
[shards]
cases = 60
)";
}

/// A sweep that has run, made once: nothing here changes it.
const fs::path& get_sweep() {
  static const TemporaryFolder folder;
  static const fs::path sweep = [] {
    std::string bump = test::read_text(kBump);
    bump.replace(bump.find("duration = 3.0"), 14, "duration = 1.5");
    const fs::path maneuver = folder.write("bump.toml", bump);
    const std::string file = folder.write("sweep.toml", make_sweep_text(maneuver, 200)).string();
    fs::path made = folder / "sweep";
    const Outcome planned = run_program("plan " + file + " -o " + made.string());
    INFO(planned.messages);
    REQUIRE(planned.code == 0);
    REQUIRE(run_program("run " + made.string()).code == 0);
    return made;
  }();
  return sweep;
}

Outcome train(const std::string& data, const fs::path& output, const std::string& options) {
  return run_program("train " + data + " -o " + output.string() +
                     " --targets front_stiffness,rear_damping --hidden 8 " + options);
}

/// Epochs that are enough to tell trainings apart, or to identify.
const std::string kShort = "--window 0.35:1.2 --copies 2 --epochs 6 ";
const std::string kLong = "--window 0.35:1.2 --copies 4 --epochs 60 ";

/// A model of that sweep, made once, and what the training printed.
struct Trained {
  Trained() {
    const Outcome outcome = train(get_sweep().string(), file, kLong + "--json");
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    printed = test::parse_json(outcome.out);
  }
  TemporaryFolder folder;
  fs::path file = folder / "window.h5";
  test::JsonTree printed;
};

const Trained& get_trained() {
  static const Trained trained;
  return trained;
}

std::vector<double> train_weights(const std::string& data, const std::string& options) {
  const TemporaryFolder folder;
  const Outcome outcome = train(data, folder / "m.h5", options);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return read_model(folder / "m.h5").weights;
}

TEST_CASE("evaluate reproduces the test figures of a noisy training", "[io][slow]") {
  const Trained& trained = get_trained();
  CHECK(trained.printed.get<int>("training_cases") == 140);
  CHECK(trained.printed.get<int>("samples") == 4 * 30);
  const std::string model = trained.file.string() + " " + get_sweep().string();
  const test::JsonTree again = test::parse_json(run_program("evaluate " + model + " --json").out);
  CHECK(again.get_child("parameters") == trained.printed.get_child("parameters"));
  CHECK(again.get<int>("samples") == 4 * 30);
  const test::JsonTree all =
      test::parse_json(run_program("evaluate " + model + " --part all --json").out);
  CHECK(all.get<int>("samples") == 4 * 200);
}

TEST_CASE("A network learns stiffness and damping from noisy windows close to their bound",
          "[statistical][slow]") {
  // The bound for this record, with the other stiffness and damping known, from central differences
  // of simulations as in docs/window.md: 88 N/m and 1.18 N s/m.
  const test::JsonTree& printed = get_trained().printed;
  CHECK(printed.get<double>("parameters.front_stiffness.RMSE") < 2.0 * 88.0);
  CHECK(printed.get<double>("parameters.rear_damping.RMSE") < 2.0 * 1.18);
}

TEST_CASE("Weights of a window's network depend neither on storage nor on batches or threads",
          "[io][property][slow]") {
  const TemporaryFolder folder;
  const std::string sweep = get_sweep().string(), merged = folder / "all.h5";
  REQUIRE(run_program("merge " + sweep + " -o " + merged).code == 0);
  const std::vector<double> weights = train_weights(sweep, kShort + "--threads 1");
  CHECK(train_weights(sweep, kShort + "--threads 2 --batch 7") == weights);
  CHECK(train_weights(sweep + "/shards/*.h5", kShort) == weights);
  CHECK(train_weights(merged, kShort) == weights);
  CHECK(train_weights(sweep, kShort + "--noise imu_rate_y=2e-3") != weights);
}

TEST_CASE("A resumed noisy training is the uninterrupted one bit for bit", "[io][property][slow]") {
  const TemporaryFolder folder;
  const std::string kind = GENERATE("--window 0.35:1.2 --copies 2 ", "--noise default --copies 2 ");
  const std::string sweep = get_sweep().string(), keep = (folder / "keep.h5").string();
  const std::string inputs =
      kind[2] == 'n' ? "--inputs body_position_z,body_velocity_z,pitch_angle " : "";
  const std::string options = kind + inputs + "--max-failures 1000 ";
  REQUIRE(train(sweep, folder / "whole.h5", options + "--epochs 12").code == 0);
  REQUIRE(train(sweep, folder / "a.h5", options + "--epochs 5 --checkpoint " + keep).code == 0);
  const std::string resume = "--epochs 12 --resume --checkpoint " + keep;
  REQUIRE(train(sweep, folder / "b.h5", options + resume).code == 0);
  CHECK(read_model(folder / "b.h5").weights == read_model(folder / "whole.h5").weights);
  const Outcome other = train(
      sweep, folder / "c.h5",
      options + "--bias " + (inputs.empty() ? "imu_rate_y" : "pitch_angle") + "=0.25 " + resume);
  CHECK(other.code == 2);
  CHECK_THAT(other.messages, Contains("a checkpoint of another training") && Contains("bias: was"));
}

TEST_CASE("A network with noisy snapshots knows its noise", "[io][slow]") {
  const TemporaryFolder folder;
  const fs::path file = folder / "m.h5";
  const std::string inputs = " --inputs body_position_z,body_velocity_z,pitch_angle --json ";
  const Outcome outcome =
      train(get_sweep().string(), file, "--noise pitch_angle=2e-4 --copies 3 --epochs 20" + inputs);
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  const Model model = read_model(file);
  REQUIRE(model.noise);
  CHECK(model.noise->sigma == std::vector{1e-3, 5e-3, 2e-4});
  CHECK(model.noise->bias == std::vector{0.0, 0.0, 0.0});
  CHECK(model.noise->copies == 3);
  const test::JsonTree trained = test::parse_json(outcome.out);
  const test::JsonTree again = test::parse_json(
      run_program("evaluate " + file.string() + " " + get_sweep().string() + " --json").out);
  CHECK(again.get_child("parameters") == trained.get_child("parameters"));
  CHECK(again.get<int>("samples") == 3 * 30);
}

/// A record of the sweep's car as a sensor with its own clock writes it: columns time,
/// acceleration, rate, with noise; samples first to last of every `step` seconds.
struct Recording {
  std::string car, rate = "500";
  double clock = 0.0, first = 0.0, last = 1.5;
  std::string accelerometer = "imu_acceleration_z";
};

fs::path record(const TemporaryFolder& folder, const std::string& name, const Recording& r) {
  const fs::path run = folder / (name + "_run.csv");
  fs::path file = folder / name;
  REQUIRE(run_program("simulate " + kCar + " " + kBump + " -o " + run.string() + " --rate " +
                      r.rate + " --set duration=1.5 " + r.car)
              .code == 0);
  const CsvTable table = read_csv(run);
  const NoiseModel noise{{0.02, 1e-3}, {0.1, 5e-3}};
  std::vector<CsvColumn> columns = {table.column("time"), table.column("imu_acceleration_z"),
                                    table.column("imu_rate_y")};
  const NoiseDraw draw(noise, 1, 0);
  for (std::size_t c = 0; c < 2; ++c) draw.add(c, columns[c + 1].values);
  std::vector<CsvColumn> kept = columns;
  for (CsvColumn& column : kept) column.values.clear();
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    const double time = columns[0].values[i];
    if (time < r.first || time > r.last) continue;
    for (std::size_t c = 0; c < 3; ++c) kept[c].values.push_back(columns[c].values[i]);
    kept[0].values.back() += r.clock;
  }
  kept[1].name = r.accelerometer;
  write_csv(file, kept);
  return file;
}

TEST_CASE("identify tells the parameters of a recorded window, wherever it begins",
          "[statistical][slow]") {
  const TemporaryFolder folder;
  const std::string model = get_trained().file.string();
  const std::string car = "--set front_stiffness=37100 --set rear_damping=1871 --set speed=20.2 ";
  // As sampled for training; by another clock, later, and in a longer record; twice as fast.
  const Recording plain{car}, later{car + "--set bump_distance=11", "500", 977.0003},
      faster{car, "1000", -3.2};
  for (const Recording& recording : {plain, later, faster}) {
    const fs::path file = record(folder, "m.csv", recording);
    const Outcome outcome = run_program("identify " + model + " " + file.string() + " --json");
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    const test::JsonTree told = test::parse_json(outcome.out);
    CHECK(told.get<bool>("in_range"));
    for (const auto& [name, truth] :
         {std::pair{"front_stiffness", 37100.0}, {"rear_damping", 1871.0}}) {
      const std::string path = std::string("parameters.") + name;
      const double value = told.get<double>(path + ".value");
      std::vector<double> bounds;
      for (const auto& [key, bound] : told.get_child(path + ".ci95")) {
        bounds.push_back(bound.get_value<double>());
      }
      // Two and a half half widths: five sigma.
      REQUIRE(bounds.size() == 2);
      CHECK(std::abs(value - truth) < 1.25 * (bounds[1] - bounds[0]));
    }
  }
}

TEST_CASE("A record of another kind is told from those trained on", "[io][slow]") {
  const TemporaryFolder folder;
  const std::string model = get_trained().file.string();
  for (const char* change :
       {"--set bump_height=0.0525", "--set front_stiffness=44000", "--set front_damping=1500"}) {
    const fs::path file = record(folder, "m.csv", {change});
    const Outcome outcome = run_program("identify " + model + " " + file.string() + " --json");
    INFO(change << outcome.out);
    CHECK(outcome.code == 1);
    const test::JsonTree told = test::parse_json(outcome.out);
    CHECK(!told.get<bool>("in_range"));
    CHECK(told.get<std::string>("parameters.front_stiffness.value") == "null");
  }
}

TEST_CASE("identify says what a record lacks for a window", "[io][slow]") {
  const TemporaryFolder folder;
  const std::string model = get_trained().file.string();
  const auto check = [&](const fs::path& file, const std::vector<std::string>& texts) {
    const Outcome outcome = run_program("identify " + model + " " + file.string());
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    for (const std::string& text : texts) CHECK_THAT(outcome.messages, Contains(text));
  };
  check(record(folder, "short.csv", {"", "500", 0.0, 0.5, 1.2}),
        {"short.csv", "from 0.5 to 1.2 s", "the window takes 0.866 s"});
  check(record(folder, "slow.csv", {"", "200"}),
        {"slow.csv:4", "0.005 s after the sample before", "500 Hz"});
  check(record(folder, "other.csv", {"", "500", 0.0, 0.0, 1.5, "imu_acceleration_x"}),
        {"other.csv", "imu_acceleration_z"});
  std::ofstream(folder / "back.csv") << "time,imu_acceleration_z,imu_rate_y\n0,9,0\n0,9,0\n";
  check(folder / "back.csv", {"back.csv:3", "time must ascend"});
  std::ofstream(folder / "unit.csv")
      << "time,imu_acceleration_z,imu_rate_y\n# units: s,g,rad/s\n0,1,0\n0.002,1,0\n";
  check(folder / "unit.csv", {"unit.csv: imu_acceleration_z is in g; must be in m/s^2"});
}

TEST_CASE("Training on windows refuses what it cannot do", "[io]") {
  const std::string sweep = get_sweep().string();
  const auto check = [&](const std::string& options, const std::vector<std::string>& texts) {
    const TemporaryFolder folder;
    const Outcome outcome = train(sweep, folder / "m.h5", options);
    INFO(outcome.messages);
    CHECK(outcome.code == 2);
    CHECK(folder.file_count() == 0);
    for (const std::string& text : texts) CHECK_THAT(outcome.messages, Contains(text));
  };
  check("--window 0.35", {"--window = 0.35: must be FROM:TO"});
  check("--window 0.35:x", {"--window = 0.35:x"});
  check("--window 0.35:1.45", {"--window = 0.35:1.45", "lie in [0.092, 1.408] s"});
  check("--window 0.35:1.2 --inputs pitch_angle",
        {"no history channel 'pitch_angle'", "imu_rate_y"});
  check("--window 0.35:1.2 --noise imu_rate_x=1", {"--noise: 'imu_rate_x' is no input"});
  check("--window 0.35:1.2 --noise imu_rate_y=-1", {"noise of imu_rate_y = -1: must be > 0"});
  check("--window 0.35:1.2 --bias imu_rate_y=-1", {"bias of imu_rate_y = -1"});
  check("--window 0.35:1.2 --hit-time-sigma -1", {"--hit-time-sigma"});
  check("--window 0.35:1.2 --copies 0", {"--copies = 0"});
  check("--window 0.35:1.2 --align 0.001", {"--align", "records agree best"});
  check("--align 0.01", {"--align needs --window"});
  check("--copies 3", {"--copies needs --noise"});
  check("--noise front_left_spring_force=1",
        {"--noise: 'front_left_spring_force' is no input", "body_position_z"});
}

}  // namespace
}  // namespace strut
