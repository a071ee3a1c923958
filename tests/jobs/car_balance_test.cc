// The balance of a car's body: its estimates of the struts with wrong bump and tires.
#include "diagnose/compare/car_balance.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "jobs/compare/json.h"
#include "jobs/compare/tables.h"
#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "tests/jobs/parse_json.h"
#include "tests/support/campaign_files.h"
#include "tests/support/fit_case.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

const std::string kExamples = STRUT_SOURCE_DIR "/examples/";

using Settings = std::vector<std::pair<std::string, double>>;

/// Differences of the measured car from the model.
struct Truth {
  Settings settings;
  BumpShape shape = BumpShape::kArc;
};

const Settings kWorn = {{"front_stiffness", 37000.0},
                        {"front_damping", 1850.0},
                        {"rear_stiffness", 33000.0},
                        {"rear_damping", 1750.0}};
// A bump 5 % higher than surveyed, tires 15 % stiffer than the file's.
const Truth kOtherRoad = {{{"bump_height", 0.0525}, {"tire_stiffness", 230000.0}}};
const Truth kOtherShape = {{}, BumpShape::kHalfSine};
constexpr double kRate = 500.0;

struct Sensor {
  std::string channel;
  double noise;
};

const std::vector<Sensor> kSensors = {{"imu_acceleration_z", 0.02},
                                      {"imu_rate_x", 1e-3},
                                      {"imu_rate_y", 1e-3},
                                      {"front_left_suspension_deflection", 3e-4},
                                      {"front_right_suspension_deflection", 3e-4},
                                      {"rear_left_suspension_deflection", 3e-4},
                                      {"rear_right_suspension_deflection", 3e-4}};

int find_car_channel(const std::string& name) {
  const auto& channels = list_car_channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].name == name) return static_cast<int>(i);
  }
  FAIL("no channel " << name);
  return 0;
}

/// Records of the paper's worn car over its bump, with the truth's other differences.
void write_crossing(const test::TemporaryFolder& folder, const std::string& name,
                    const Truth& truth, std::uint64_t seed) {
  Case c{read_vehicle(kExamples + "vehicles/paper_sedan.toml"),
         read_maneuver(kExamples + "maneuvers/bump_20mps.toml")};
  for (const auto& [parameter, value] : kWorn) set_parameter(c, parameter, value);
  for (const auto& [parameter, value] : truth.settings) set_parameter(c, parameter, value);
  c.maneuver.road.shape = truth.shape;
  const LaneResults results = test::simulate_truth(c, kRate, false);
  std::string text = "time";
  for (const Sensor& s : kSensors) text += "," + s.channel;
  for (int i = 0; i < results.sample_count; ++i) {
    text += "\n" + test::print_number(i / kRate);
    for (std::size_t k = 0; k < kSensors.size(); ++k) {
      const double value =
          results.get_sample(i, find_car_channel(kSensors[k].channel)) +
          kSensors[k].noise * test::calc_test_normal(seed, k, static_cast<std::uint64_t>(i));
      text += "," + test::print_number(value);
    }
  }
  folder.write(name, text + "\n");
}

CampaignData make_campaign(const test::TemporaryFolder& folder, const Truth& truth,
                           const std::string& more_free = "", const std::string& more_run = "") {
  std::string text =
      "model = \"" + kExamples + "vehicles/paper_sedan.toml\"\n[columns]\ntime = {}\n";
  for (const Sensor& s : kSensors) {
    text += s.channel + " = { noise = " + test::print_number(s.noise) + " }\n";
  }
  text +=
      "[fit]\nfree = [\"front_stiffness\", \"front_damping\", \"rear_stiffness\", "
      "\"rear_damping\"" +
      more_free + "]\n";
  std::uint64_t seed = 1;
  for (const char* run : {"fit", "hold_out"}) {
    write_crossing(folder, std::string(run) + ".csv", truth, seed++);
    text += std::string("[[run]]\nfile = \"") + run + ".csv\"\nuse = \"" + run +
            "\"\nmaneuver = \"" + kExamples + "maneuvers/bump_20mps.toml\"\n" + more_run;
  }
  return read_campaign_data(folder.write("campaign.toml", text));
}

/// Results of the whole fit and of the balance of its run.
struct Answers {
  std::vector<double> fit;
  CarBalance balance;
};

Answers ask(const Truth& truth) {
  const test::TemporaryFolder folder;
  const CampaignData data = make_campaign(folder, truth);
  const Baseline baseline = calibrate_baseline(data);
  const auto balance =
      calc_car_balance(data, 0, baseline.calibrated, evaluate_run(data, 0, baseline.calibrated));
  REQUIRE(balance);
  REQUIRE(balance->parameters.size() == kWorn.size());
  return {baseline.calibrated.values, *balance};
}

/// Largest relative difference of two answers.
double calc_move(const std::vector<double>& from, const std::vector<double>& to) {
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    largest = std::max(largest, std::abs(to[i] / from[i] - 1.0));
  }
  return largest;
}

TEST_CASE("A car's balance identifies its struts for any bump and tires, and shows a wrong strut",
          "[regression]") {
  const Answers right = ask({});
  for (std::size_t i = 0; i < kWorn.size(); ++i) {
    const BalanceParameter& p = right.balance.parameters[i];
    CHECK(p.name == kWorn[i].first);
    // Four standard deviations.
    CHECK(std::abs(p.value - kWorn[i].second) < test::tolerance(4.0 * p.sigma));
  }
  // At most noise and an unknown road.
  CHECK(right.balance.chi2_per_reading < 1.0);
  for (const Truth& truth : {kOtherRoad, kOtherShape}) {
    const Answers wrong = ask(truth);
    for (std::size_t i = 0; i < kWorn.size(); ++i) {
      const BalanceParameter &r = right.balance.parameters[i], &w = wrong.balance.parameters[i];
      INFO(r.name << " " << r.value << " +- " << r.sigma << ", " << w.value);
      // The same noise in both: what moves is the balance.
      CHECK(std::abs(w.value / r.value - 1.0) < test::tolerance(2e-3));
    }
    // The fit of all readings takes the bump for the struts.
    CHECK(calc_move(right.fit, wrong.fit) > 0.02);
    CHECK(wrong.balance.chi2_per_reading < 1.0);
  }
  CHECK(ask({{{"rear_damper_asymmetry", 0.3}}}).balance.chi2_per_reading > 5.0);
}

TEST_CASE("With free bump and tires the whole fit is immune to these, but not to another shape",
          "[regression]") {
  const auto fit = [](const Truth& truth) {
    const test::TemporaryFolder folder;
    std::vector<double> values =
        calibrate_baseline(
            make_campaign(folder, truth, ", \"tire_stiffness\"", "bump_height = [0.05, 0.005]\n"))
            .calibrated.values;
    values.resize(kWorn.size());
    return values;
  };
  const std::vector<double> right = fit({});
  CHECK(calc_move(right, fit(kOtherRoad)) < test::tolerance(2e-3));
  CHECK(calc_move(right, fit(kOtherShape)) > 5e-3);
}

TEST_CASE("Without measured deflections there is no balance of a car", "[regression]") {
  const test::TemporaryFolder folder;
  CampaignData data = make_campaign(folder, {});
  RunEvaluation at;
  const SharedValues nominal;
  const int rear = find_car_channel("rear_left_suspension_deflection");
  std::erase_if(data.runs[0].channels, [&](const MeasuredChannel& c) { return c.channel >= rear; });
  CHECK(!calc_car_balance(data, 0, nominal, at));
  at.failure = "not simulated";
  CHECK(!calc_car_balance(data, 1, nominal, at));
}

TEST_CASE("A bump by table has a car's balance, and a road without a bump does not stop it",
          "[regression]") {
  const test::TemporaryFolder folder;
  CampaignData data = make_campaign(folder, {});
  const Baseline baseline = calibrate_baseline(data);
  const auto balance = [&] {
    return calc_car_balance(data, 0, baseline.calibrated,
                            evaluate_run(data, 0, baseline.calibrated));
  };
  const auto arc = balance();
  RoadSpec& road = data.runs[0].setup.car().maneuver.road;
  const RoadSpec formula = road;
  for (int i = 0; i <= 200; ++i) {
    const double x = formula.length * (i / 200.0 - 0.5);
    road.table_x.push_back(x);
    road.table_z.push_back(calc_profile_height(formula, x));
  }
  road.shape = BumpShape::kTable;
  const auto table = balance();
  REQUIRE((arc && table));
  for (std::size_t i = 0; i < kWorn.size(); ++i) {
    // A bump that is surveyed and not fitted leaves the struts where they are.
    CHECK(std::abs(table->parameters[i].value - arc->parameters[i].value) <
          test::tolerance(4.0 * arc->parameters[i].sigma));
  }
  road = formula;
  road.shape = BumpShape::kNone;
  CHECK_NOTHROW(balance());
}

TEST_CASE("compare.json and the report have a car's balance", "[io]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_campaign(folder, {});
  Comparison comparison;
  comparison.runs.resize(1);
  CarBalance balance;
  balance.parameters = {{"front_stiffness", "N/m", 37000.0, 100.0}};
  balance.chi2_per_reading = 4.0;
  comparison.runs.front().car_balance = balance;
  const auto json = test::parse_json(format_json(make_compare_json(data, comparison)));
  const auto& told = json.get_child("runs").front().second.get_child("balance");
  CHECK(told.get<double>("chi2_per_reading") == 4.0);
  CHECK(told.get<double>("parameters.front_stiffness.value") == 37000.0);
  // 1.96 sigma to either side.
  CHECK(told.get_child("parameters.front_stiffness.ci95").back().second.get_value<double>() ==
        Approx(37196.0).epsilon(1e-6));
  const ReportTable table = make_run_tables(data, comparison.runs.front()).back();
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].back() == "2");  // times the noise
  CHECK(table.rows[1].front() == "front_stiffness");
}

}  // namespace
}  // namespace strut
