#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "diagnose/campaign/campaign_data.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "estimate/recording/check.h"
#include "estimate/recording/check_alignment.h"
#include "estimate/recording/check_readings.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::QuarterTruth;
using test::TemporaryFolder;

/// Springs and dampers far from those of the model's file, and friction that it lacks.
QuarterTruth make_worn(double stiffness_factor, double damping_factor) {
  QuarterTruth truth;
  truth.stiffness *= stiffness_factor;
  truth.damping *= damping_factor;
  truth.friction = 0.2;
  truth.noise = 2e-5;
  return truth;
}

/// Two recordings of that car; `change` alters every row of both.
CampaignData read_worn(const QuarterTruth& truth, const test::ChangeRow& change = {}) {
  const TemporaryFolder folder;
  QuarterTruth other = truth;
  other.amplitude *= 1.5;
  other.seed = 2;
  test::write_record(folder, "a.csv", test::record_quarter_car(truth), change);
  test::write_record(folder, "b.csv", test::record_quarter_car(other), change);
  return read_campaign_data(test::write_campaign(folder));
}

std::vector<RecordingFinding> check(const CampaignData& data) {
  return check_recordings(data.runs, make_free_unknowns(data, {0}));
}

std::vector<RecordingFinding> check_changed(const test::ChangeRow& change) {
  return check(read_worn(make_worn(0.7, 1.3), change));
}

std::vector<std::string> describe(const std::vector<RecordingFinding>& findings) {
  std::vector<std::string> list;
  list.reserve(findings.size());
  for (const RecordingFinding& finding : findings) list.push_back(finding.describe());
  return list;
}

/// Scales the cell of a row: 1 road, 2 unsprung, 3 sprung.
test::ChangeRow scale_cell(std::size_t cell, double factor) {
  return [=](std::size_t, std::array<std::string, 4>& cells) {
    cells[cell] = test::print_number(factor * std::stod(cells[cell]));
  };
}

using Texts = std::vector<std::string>;

TEST_CASE("Wear and friction are no mistakes of a recording", "[reference]") {
  for (const double stiffness : {0.6, 1.0, 1.4}) {
    for (const double damping : {0.6, 1.4}) {
      CAPTURE(stiffness, damping);
      CHECK(check(read_worn(make_worn(stiffness, damping))).empty());
    }
  }
}

TEST_CASE("Wrong signs and units are found in spite of wear", "[reference]") {
  CHECK(describe(check_changed(scale_cell(3, -1.0))) ==
        Texts{"sprung_position looks negated: sign = -1"});
  CHECK(describe(check_changed(scale_cell(1, -1.0))) ==
        Texts{"road_position looks negated: sign = -1"});
  const auto large = check_changed(scale_cell(2, 9.81));
  REQUIRE(large.size() == 1);
  CHECK(large[0].kind == FindingKind::kFactor);
  CHECK(large[0].channel == "unsprung_position");
  CHECK(large[0].size == Approx(9.81).epsilon(0.1));
  CHECK_THAT(check_changed(scale_cell(2, 100.0)).at(0).describe(), Contains("unit = \"cm\"?"));
  const auto input = check_changed(scale_cell(1, 100.0));
  REQUIRE(input.size() == 1);
  CHECK(input[0].channel == "road_position");
  CHECK_THAT(input[0].describe(), Contains("unit = \"cm\"?"));
}

/// Reads the cell from `rows` rows before.
test::ChangeRow delay_cell(std::size_t cell, std::size_t rows) {
  auto queue = std::make_shared<std::vector<std::string>>();
  return [=](std::size_t row, std::array<std::string, 4>& cells) {
    if (row == 0) queue->clear();
    queue->push_back(cells[cell]);
    cells[cell] = (*queue)[row < rows ? 0 : row - rows];
  };
}

TEST_CASE("Late channels and late clocks are told apart", "[reference]") {
  const auto single = check_changed(delay_cell(3, 4));  // 20 ms
  REQUIRE(single.size() == 1);
  CHECK(single[0].kind == FindingKind::kLag);
  CHECK(single[0].channel == "sprung_position");
  CHECK(single[0].size == Approx(0.020).margin(0.006));
  const auto early = check_changed(delay_cell(1, 4));  // the input is late: all else is early
  REQUIRE(early.size() == 1);
  CHECK(early[0].channel.empty());
  CHECK(early[0].size == Approx(-0.020).margin(0.006));
  CHECK_THAT(early[0].describe(), Contains("ms early against road_position: delay = 0.0"));
}

TEST_CASE("A column of something else is found, and two that are swapped", "[reference]") {
  const auto other = check_changed([](std::size_t, std::array<std::string, 4>& cells) {
    cells[3] = test::print_number(2e-3 * std::sin(70.0 * std::stod(cells[0])));
  });
  REQUIRE(other.size() == 1);
  CHECK(other[0].kind == FindingKind::kStranger);
  CHECK(other[0].channel == "sprung_position");
  CHECK(describe(check_changed([](std::size_t, std::array<std::string, 4>& cells) {
          std::swap(cells[2], cells[3]);
        })) == Texts{"unsprung_position and sprung_position look swapped: swap their columns"});
}

TEST_CASE("Start values so far off that nothing agrees are named as a cause", "[reference]") {
  QuarterTruth truth = make_worn(1.0, 1.0);
  truth.stiffness *= 3.2;
  const auto findings = check(read_worn(truth));
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].kind == FindingKind::kStranger);
  CHECK_THAT(findings[1].describe(), Contains("far start values"));
}

TEST_CASE("The phase of a steady oscillation is no lag", "[unit]") {
  ChannelAlignment run;
  run.correlation = 0.99;
  run.lag = 0.03;
  run.sign_ratio = run.lag_ratio = 5.0;
  const auto find = [&](double period) {
    run.period = period;
    CampaignData data = read_worn(make_worn(1.0, 1.0));
    data.runs.erase(data.runs.begin() + 1, data.runs.end());
    data.runs[0].channels.erase(data.runs[0].channels.begin() + 1, data.runs[0].channels.end());
    Alignment alignment;
    alignment.channels = {run};
    return check_alignment(data.runs, alignment).size();
  };
  CHECK(find(0.0) == 1);    // a motion that does not repeat itself
  CHECK(find(0.5) == 1);    // 2 Hz: a sixteenth of a turn
  CHECK(find(0.125) == 0);  // 8 Hz: a quarter of a turn
}

TEST_CASE("A sensor at its limit, coarse readings and mains are found", "[unit]") {
  const auto clip = check_changed([](std::size_t, std::array<std::string, 4>& cells) {
    cells[3] = test::print_number(std::clamp(std::stod(cells[3]), -0.0015, 0.0015));
  });
  REQUIRE(clip.size() == 1);
  CHECK_THAT(clip[0].describe(), Contains("sprung_position is cut off at 0.0015 in"));
  const auto coarse = check_changed([](std::size_t, std::array<std::string, 4>& cells) {
    cells[2] = test::print_number(5e-4 * std::round(std::stod(cells[2]) / 5e-4));
  });
  REQUIRE(coarse.size() == 1);
  CHECK_THAT(coarse[0].describe(), Contains("unsprung_position has steps of 0.00050"));
  const auto mains = check_changed([](std::size_t, std::array<std::string, 4>& cells) {
    const double tone = 5e-5 * std::sin(2.0 * std::numbers::pi * 50.0 * std::stod(cells[0]));
    cells[2] = test::print_number(std::stod(cells[2]) + tone);
  });
  REQUIRE(mains.size() == 1);
  CHECK(mains[0].size == 50.0);
  CHECK_THAT(mains[0].describe(), Contains("(and in 1 other runs)"));
}

TEST_CASE("A quiet run makes no sensor coarse, and equal readings within noise are no limit",
          "[unit]") {
  CampaignData data = read_worn(make_worn(0.7, 1.3));
  const double step = 1e-5;
  for (std::size_t r = 0; r < 2; ++r) {
    for (double& v : data.runs[r].channels.front().values) {
      v = step * std::round(v * (r == 0 ? 0.02 : 1.0) / step);
    }
  }
  CHECK(check_sensors({data.runs[0]}).size() == 1);
  CHECK(check_sensors(data.runs).empty());

  MeasuredRun run = read_worn(make_worn(0.7, 1.3)).runs[0];
  MeasuredChannel& channel = run.channels.front();
  const auto peak = std::max_element(channel.values.begin() + 10, channel.values.end() - 10);
  const double top = *peak + 5e-5;
  for (std::ptrdiff_t i = -1; i <= 1; ++i) peak[i] = top;
  channel.sigma = 2e-5;
  CHECK(check_sensors({run}).empty());
  channel.sigma = 1e-6;
  CHECK(check_sensors({run}).size() == 1);
}

TEST_CASE("Gaps and jitter of a clock are found", "[unit]") {
  CampaignData data = read_worn(make_worn(0.7, 1.3));
  MeasuredRun& run = data.runs[0];
  const auto cut = [](std::vector<double>& v) { v.erase(v.begin() + 300, v.begin() + 303); };
  cut(run.times);
  for (MeasuredChannel& c : run.channels) cut(c.values);
  const auto gap = check(data);
  REQUIRE(gap.size() == 1);
  CHECK(gap[0].kind == FindingKind::kDroppedSamples);
  CHECK(gap[0].size == 3.0);
  CHECK_THAT(gap[0].describe(),
             Contains("a.csv: 3 samples are missing in 1 gaps, the first at 1.495"));
  QuarterTruth truth = make_worn(0.7, 1.3);
  truth.jitter = 0.0008;
  const auto jitter = check(read_worn(truth));
  REQUIRE(jitter.size() == 2);
  CHECK(jitter[0].kind == FindingKind::kUnevenClock);
}

TEST_CASE("A held-out run that is a copy is found, also of a part", "[unit]") {
  CampaignData data = read_worn(make_worn(0.7, 1.3));
  data.runs[1].channels = data.runs[0].channels;
  for (MeasuredChannel& c : data.runs[1].channels) {
    std::rotate(c.values.begin(), c.values.begin() + 250, c.values.end());
  }
  std::vector<FindingKind> kinds;
  for (const RecordingFinding& f : check(data)) kinds.push_back(f.kind);
  CHECK(std::count(kinds.begin(), kinds.end(), FindingKind::kCopy) == 1);
}

TEST_CASE("Runs with a slow channel, or with one equal channel of two, are no copies", "[unit]") {
  const auto count_copies = [](const CampaignData& data) {
    std::vector<FindingKind> kinds;
    for (const RecordingFinding& f : check(data)) kinds.push_back(f.kind);
    return std::count(kinds.begin(), kinds.end(), FindingKind::kCopy);
  };
  CampaignData slow = read_worn(make_worn(0.7, 1.3));
  for (MeasuredRun& run : slow.runs) {
    std::vector<double>& values = run.channels.front().values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i % 20 != 0) values[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  CHECK(count_copies(slow) == 0);
  CampaignData half = read_worn(make_worn(0.7, 1.3));
  half.runs[1].channels.front() = half.runs[0].channels.front();
  CHECK(count_copies(half) == 0);
}

/// A car's run with two channels, and how they agree with the simulation.
struct CarAlignment {
  std::vector<MeasuredRun> runs;
  Alignment alignment;

  CarAlignment() {
    const Model car{test::make_paper_case()};
    const auto front = find_channel(car.info(), "front_left_suspension_deflection");
    const auto rear = find_channel(car.info(), "rear_left_suspension_deflection");
    runs.push_back({"drive.csv", car, {0.0, 0.01}, {{front, 1e-4, {}}, {rear, 1e-4, {}}}});
    alignment.channels = {{0, 0, 0.95, 1.1, 1.0, 0.0, 5.0, 1.0},
                          {0, 1, 0.95, 0.9, 1.0, 0.0, 5.0, 1.0}};
  }
  bool is_clean() const { return check_alignment(runs, alignment).empty(); }
  Texts describe() const { return strut::describe(check_alignment(runs, alignment)); }
};

TEST_CASE("Limits of sign, factor, lag and swap", "[unit]") {
  CarAlignment car;
  CHECK(car.is_clean());
  ChannelAlignment& rear = car.alignment.channels[1];
  SECTION("a factor that wear explains") {
    rear.factor = 1.85;
    CHECK(car.is_clean());
    rear.factor = 2.0;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 2.0 times what the model "
                                  "predicts: scale = 0.500?"});
  }
  SECTION("a factor of a column that is read in another unit than it is in") {
    car.runs[0].channels[1].reading.unit = 1e-3;
    rear.factor = 0.0394;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 0.039 times what the model "
                                  "predicts: unit = \"in\"?"});
    rear.factor = 0.001;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 0.0010 times what the model "
                                  "predicts: unit = \"m\"?"});
    // A scale of the campaign's own stays, so the advice is all of it.
    car.runs[0].channels[1].reading.scale = 2.0;
    rear.factor = 0.25;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 0.25 times what the model "
                                  "predicts: scale = 8.00?"});
  }
  SECTION("a lag of a column that is taken to be late already") {
    car.runs[0].channels[1].reading.delay = 0.03;
    rear.lag = 0.02;
    rear.lag_ratio = 2.0;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 20 ms late: delay = 0.0500 "
                                  "if another clock recorded it; or is it filtered?"});
  }
  SECTION("a sign that the data hardly tell") {
    rear.factor = -0.9;
    rear.sign_ratio = 1.2;
    CHECK(car.is_clean());
    rear.sign_ratio = 2.0;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection looks negated: sign = -1"});
  }
  SECTION("lags") {
    rear.lag = 0.02;
    CHECK(car.is_clean());  // it explains nothing
    rear.lag_ratio = 2.0;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 20 ms late: delay = 0.0200 "
                                  "if another clock recorded it; or is it filtered?"});
    car.alignment.channels[0].lag = 0.02;
    car.alignment.channels[0].lag_ratio = 2.0;
    CHECK(car.describe() ==
          Texts{"all channels are 20 ms late: offset of time, or hit_time of the runs"});
  }
  SECTION("a channel that agrees with nothing") {
    rear.factor = -3.0;
    rear.correlation = 0.5;
    CHECK(car.is_clean());
  }
  SECTION("a channel that agrees in one run of three") {
    for (const std::size_t run : {1U, 2U}) {
      car.runs.push_back(car.runs[0]);
      car.alignment.channels.push_back({run, 0, 0.95, 1.1, 1.0, 0.0, 5.0, 1.0});
      car.alignment.channels.push_back({run, 1, 0.1, 1.0, 1.0, 0.0, 1.0, 1.0});
    }
    car.alignment.channels[1].factor = -2.0;
    CHECK(car.is_clean());
    // Only one-sided bumps make a car roll.
    for (const std::size_t quiet : {3U, 5U}) car.alignment.channels[quiet].motion = 0.05;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection looks negated: sign = -1",
                                  "rear_left_suspension_deflection is 2.0 times what the model "
                                  "predicts: scale = 0.500?"});
    car.alignment.channels[1].correlation = 0.85;
    CHECK(car.is_clean());
  }
  SECTION("a channel that moves in one run only, which is late as a whole") {
    // Four more channels and two more runs; the second channel moves in the first run only.
    const ModelInfo& info = car.runs[0].setup.info();
    for (const char* name : {"front_right_suspension_deflection", "imu_rate_y",
                             "rear_right_suspension_deflection", "imu_acceleration_z"}) {
      car.runs[0].channels.push_back({find_channel(info, name), 1e-4, {}});
    }
    car.runs.resize(3, car.runs[0]);
    car.alignment.channels.clear();
    for (std::size_t run = 0; run < 3; ++run) {
      for (std::size_t channel = 0; channel < 6; ++channel) {
        const double lag = run == 0 ? 0.015 + 0.002 * static_cast<double>(channel) : 0.001;
        car.alignment.channels.push_back({run, channel, 0.95, 1.0, 1.0, lag, 5.0, 2.0});
      }
    }
    for (const std::size_t quiet : {7U, 13U}) car.alignment.channels[quiet].motion = 0.01;
    CHECK(car.is_clean());
    car.alignment.channels[1].lag = 0.041;
    CHECK(car.describe() == Texts{"rear_left_suspension_deflection is 20 ms late: delay = 0.0200 "
                                  "if another clock recorded it; or is it filtered?"});
    // All runs are late: the clock's lag is told once, that of this channel with it.
    for (ChannelAlignment& a : car.alignment.channels) a.lag = 0.02;
    CHECK(car.describe() ==
          Texts{"all channels are 20 ms late: offset of time, or hit_time of the runs"});
  }
  SECTION("swapped channels") {
    car.alignment.swaps = {{0, 0, 1, 1.0}};
    CHECK(car.is_clean());
    car.alignment.swaps = {{0, 0, 1, 3.0}};
    rear.lag = 0.13;
    rear.lag_ratio = 4.0;
    CHECK(car.describe() ==
          Texts{"front_left_suspension_deflection and "
                "rear_left_suspension_deflection look swapped: swap their columns"});
  }
}

TEST_CASE("Advice for an input is for the column that was recorded of it", "[unit]") {
  // A quarter car, both channels late by 20 ms; the campaign lists the actuator before the road,
  // whose acceleration was recorded and is taken to be late by 5 ms.
  RigSpec rig;
  rig.kind = RigKind::kQuarterCar;
  MeasuredRun run{"drive.csv", Model(RigCase{rig, {}}), {0.0, 0.01}, {}};
  const std::vector<double> zeros = {0.0, 0.0};
  run.setup.rig().inputs = {make_signal("actuator_force", run.times, zeros, Interpolation::kLinear),
                            make_signal("road_position", run.times, zeros, Interpolation::kLinear)};
  run.input_noise = {{.reading = {1.0, 1.0, 0.07}},
                     {.derivative = 2, .reading = {9.80665, 1.0, 0.005}}};
  for (const char* name : {"unsprung_position", "sprung_position"}) {
    run.channels.push_back({find_channel(run.setup.info(), name), 1e-4, {}});
  }
  Alignment alignment;
  alignment.channels = {{0, 0, 0.95, 1.0, 1.0, 0.02, 5.0, 2.0},
                        {0, 1, 0.95, 1.0, 1.0, 0.02, 5.0, 2.0}};
  CHECK(strut::describe(check_alignment({run}, alignment)) ==
        Texts{"all channels are 20 ms late against road_acceleration: delay = -0.0150 of "
              "road_acceleration"});
  for (ChannelAlignment& a : alignment.channels) {
    a.lag = 0.0;
    a.factor = 1.0 / 9.80665;  // the input is in m/s^2, and read in g
  }
  CHECK(strut::describe(check_alignment({run}, alignment)) ==
        Texts{"road_acceleration is 9.8 times what the channels that it drives suggest: unit = "
              "\"m/s^2\"?"});
}

}  // namespace
}  // namespace strut
