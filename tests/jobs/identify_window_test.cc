// Recorded windows, as `strut identify` meets them.
#include <catch2/catch.hpp>
#include <fstream>

#include "identify/window.h"
#include "io/store/shard_layout.h"
#include "io/table/csv.h"
#include "tests/jobs/window_sweep.h"
#include "train/model/model_file.h"
#include "train/window/rows.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::get_trained;
using test::kBump;
using test::kCar;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
namespace fs = std::filesystem;

/// A record of the sweep's car as a sensor with its own clock writes it: columns time,
/// acceleration, rate, with noise; samples at `rate` from first to last, but for one.
struct Recording {
  std::string car, rate = "500";
  double clock = 0.0, first = 0.0, last = 1.5;
  std::string accelerometer = "imu_acceleration_z";
  double noise = 1.0;          // relative to the noise of the training
  std::size_t lost = 1 << 30;  // the sample that is not written
};

fs::path record(const TemporaryFolder& folder, const std::string& name, const Recording& r) {
  const fs::path run = folder / (name + "_run.csv");
  fs::path file = folder / name;
  REQUIRE(run_program("simulate " + kCar + " " + kBump + " -o " + run.string() +
                      " --force --rate " + r.rate + " --set duration=1.5 " + r.car)
              .code == 0);
  const CsvTable table = read_csv(run);
  const NoiseModel noise{{0.02 * r.noise, 1e-3 * r.noise}, {0.3, 0.02}};
  std::vector<CsvColumn> columns = {table.column("time"), table.column("imu_acceleration_z"),
                                    table.column("imu_rate_y")};
  const NoiseDraw draw(noise, 1, 0);
  for (std::size_t c = 0; c < 2; ++c) draw.add(c, columns[c + 1].values);
  std::vector<CsvColumn> kept = columns;
  for (CsvColumn& column : kept) column.values.clear();
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    const double time = columns[0].values[i];
    if (time < r.first || time > r.last || i == r.lost) continue;
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
  std::vector<std::pair<Recording, std::string>> cases;
  for (const char* change : {"--set bump_height=0.0525", "--set front_stiffness=44000",
                             "--set front_damping=1500", "--set speed=18.5"}) {
    cases.emplace_back(Recording{change}, "component_");
  }
  cases.emplace_back(Recording{"", "500", 0.0, 0.0, 1.5, "imu_acceleration_z", 1.5}, "leftover");
  cases.emplace_back(Recording{"", "500", 0.0, 0.45, 1.5}, "alignment");  // the bump's half is gone
  for (const auto& [recording, channel] : cases) {
    const fs::path file = record(folder, "m.csv", recording);
    const Outcome outcome = run_program("identify " + model + " " + file.string() + " --json");
    INFO(recording.car << outcome.out << outcome.messages);
    CHECK(outcome.code == 1);
    const test::JsonTree told = test::parse_json(outcome.out);
    CHECK(!told.get<bool>("in_range"));
    CHECK(told.get<std::string>("parameters.front_stiffness.value") == "null");
    std::string outside;
    for (const auto& [key, one] : told.get_child("outside")) {
      outside += one.get<std::string>("channel") + " ";
    }
    CHECK_THAT(outside, Contains(channel));
  }
}

TEST_CASE("Intervals hold the parameters of unseen cars with unseen noise", "[statistical][slow]") {
  const TemporaryFolder folder;
  const fs::path data = test::make_sweep(folder, 7);
  const TrainedModel model = read_trained_model(get_trained().file);
  WindowTransform transform = *model.window;
  transform.noise.seed = 99;
  Dataset dataset({data}, {.histories = true});
  const RowChoice choice{list_names(transform.channels), list_names(model.targets)};
  const WindowRecords records = read_records_for(transform, choice, dataset, {});
  const Identifier identifier(model);
  std::vector<double> row(records.rows.columns());
  int held = 0, told = 0;
  for (std::size_t i = 0; i < records.rows.row_count(); ++i) {
    records.rows.read(i, 1, row.data());
    MeasuredRecord record{std::vector<double>(transform.record_size()),
                          transform.grid.record_samples(), 0.0};
    const NoiseDraw draw(transform.noise, static_cast<std::int64_t>(i), 0);
    draw_record(records, row, transform.noise, draw, false, record.values);
    const IdentifiedRow found = identify_record(model, identifier, record, false);
    if (!found.outside.empty()) continue;
    for (std::size_t t = 0; t < 2; ++t, ++told) {
      const IdentifiedParameter& p = found.parameters[t];
      if (std::abs(p.value - row[row.size() - 2 + t]) <= p.half_width) ++held;
    }
  }
  CHECK(told >= 380);
  // Binomial 1.1 %; the width, of 120 validation rows of 30 cars, 2 to 3 %; three of both.
  CHECK(static_cast<double>(held) / told == Approx(0.95).margin(0.09));
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
        {"slow.csv: 200 samples per second; must be at least 500"});
  check(record(folder, "other.csv", {"", "500", 0.0, 0.0, 1.5, "imu_acceleration_x"}),
        {"other.csv", "imu_acceleration_z"});
  check(record(folder, "gap.csv", {"", "500", 0.0, 0.0, 1.5, "imu_acceleration_z", 1.0, 400}),
        {"gap.csv:403: 0.004 s after the sample before", "500 Hz"});
  std::ofstream(folder / "back.csv") << "time,imu_acceleration_z,imu_rate_y\n0,9,0\n0,9,0\n";
  check(folder / "back.csv", {"back.csv:3", "time must ascend"});
  std::ofstream(folder / "unit.csv")
      << "time,imu_acceleration_z,imu_rate_y\n# units: s,N,rad/s\n0,1,0\n0.002,1,0\n";
  check(folder / "unit.csv", {"unit.csv: column 'imu_acceleration_z': unit \"N\""});
  std::ofstream(folder / "clock.csv")
      << "time,imu_acceleration_z,imu_rate_y\n# units: mm,m/s^2,rad/s\n0,1,0\n2,1,0\n";
  check(folder / "clock.csv", {"clock.csv: column 'time': unit \"mm\""});
  std::ofstream(folder / "nan.csv") << "time,imu_acceleration_z,imu_rate_y\n0,9,nan\n0.002,9,0\n";
  check(folder / "nan.csv", {"nan.csv:2: imu_rate_y = 'nan': must be a finite number"});
}

}  // namespace
}  // namespace strut
