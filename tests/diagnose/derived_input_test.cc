// Inputs that were recorded as their time derivatives, and the biases of their sensors.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "base/error/input_error.h"
#include "diagnose/compare/compare.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::CampaignText;
using test::TemporaryFolder;

constexpr double kDuration = 4.0, kRate = 500.0;

/// The derivative of the test's road by central differences.
double derive_road(const test::QuarterTruth& truth, double t, int derivative) {
  if (derivative == 0) return test::calc_test_road(truth, t, kDuration);
  const double h = 1e-4;
  return (derive_road(truth, t + h, derivative - 1) - derive_road(truth, t - h, derivative - 1)) /
         (2.0 * h);
}

/// Two runs whose road is recorded as a time derivative, by a sensor with a bias.
CampaignData read_derived(int derivative, const std::string& channel, double bias,
                          const std::string& more = "") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.csv", "b.csv"}) {
    test::QuarterTruth truth;
    truth.noise = 1e-5;
    if (name == "b.csv") {
      truth.amplitude = 0.0013;
      truth.seed = 2;
    }
    const test::QuarterRecord record = test::record_quarter_car(truth, kDuration, kRate);
    test::write_record(folder, name, record, [&](std::size_t row, auto& cells) {
      cells[1] = test::print_number(derive_road(truth, record.time[row], derivative) + bias);
    });
  }
  return read_campaign_data(folder.write(
      "campaign.toml", "model = \"" STRUT_SOURCE_DIR
                       "/examples/rigs/quarter_car.toml\"\n[columns]\n"
                       "time = { column = \"t\" }\n" +
                           channel + " = { column = \"road\", role = \"input\"" + more +
                           " }\nunsprung_position = { column = \"unsprung\" }\n"
                           "sprung_position = { column = \"sprung\" }\n" +
                           CampaignText{}.fit.insert(0, "[fit]\n") + CampaignText{}.runs));
}

void check_calibrated(const CampaignData& data) {
  const Comparison comparison = compare_campaign(data);
  CHECK(comparison.is_adequate());
  const std::vector<double>& found = comparison.baseline.calibrated.values;
  // unsprung mass, stiffness, damping, tire stiffness, tire damping of QuarterTruth
  const double truth[] = {1.1, 950.0, 8.0, 1300.0, 6.0};
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(found[i] == Approx(truth[i]).epsilon(test::tolerance(0.01)));
  }
}

TEST_CASE("A road recorded as a velocity drives a rig, whatever the sensor's bias", "[reference]") {
  check_calibrated(read_derived(1, "road_velocity", 2e-3));
}

TEST_CASE("A road recorded as an acceleration drives a rig, whatever the sensor's bias",
          "[reference]") {
  check_calibrated(read_derived(2, "road_acceleration", 0.05));
}

TEST_CASE("A stated bias of an input is removed", "[unit]") {
  const CampaignData data = read_derived(0, "road_position", 0.03, ", bias = 0.03");
  const InputSignal& road = data.runs[0].setup.rig().inputs.front();
  for (double t = 0.0; t < kDuration; t += 0.1) {
    CHECK(calc_signal(road, t).value ==
          Approx(derive_road({}, t, 0)).margin(test::tolerance(1e-8)));
  }
}

TEST_CASE("A derivative that the model does not have cannot drive it", "[unit]") {
  CHECK_THROWS_WITH(read_derived(1, "sprung_velocity", 0.0),
                    Contains("sprung_velocity") && Contains("road_velocity, road_acceleration"));
  CHECK_THROWS_WITH(
      read_derived(1, "road_velocity", 0.0, " }\nroad_position = { column = \"road\""),
      Contains("road_position") && Contains("twice"));
}

/// A mass on a smooth table, pushed by a force whose sensor is off by `offset`; Heun's method.
std::string record_pushed(double amplitude, double offset, std::uint64_t seed) {
  constexpr double kStep = 1e-4, kMass = 4.0, kDamping = 3.0, kNoise = 1e-5;
  const auto push = [&](double t) { return amplitude * std::sin(5.0 * t); };
  double x = 0.0, v = 0.0;
  std::string text = "t,F,x\n";
  for (int i = 0; i <= 40000; ++i) {
    const double t = kStep * i;
    if (i % 50 == 0) {
      const double reading =
          x + kNoise * test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(i));
      text += test::print_number(t) + "," + test::print_number(push(t) + offset) + "," +
              test::print_number(reading) + "\n";
    }
    const double a = (push(t) - kDamping * v) / kMass, ahead = v + kStep * a;
    const double b = (push(t + kStep) - kDamping * ahead) / kMass;
    x += 0.5 * kStep * (v + ahead);
    v += 0.5 * kStep * (a + b);
  }
  return text;
}

TEST_CASE("A force sensor's bias is found where the campaign frees it", "[reference]") {
  const bool is_free = GENERATE(true, false);
  const TemporaryFolder folder;
  folder.write("a.csv", record_pushed(20.0, 0.7, 1));
  folder.write("b.csv", record_pushed(15.0, -0.4, 2));
  folder.write("rig.toml", "type = \"single_mass\"\nmass = 3\nstiffness = 0\ndamping = 2\n");
  const CampaignData data = read_campaign_data(folder.write(
      "campaign.toml", std::string("model = \"rig.toml\"\n[columns]\ntime = { column = \"t\" }\n"
                                   "force = { column = \"F\"") +
                           (is_free ? ", bias = [0, 2]" : "") +
                           " }\nposition = { column = \"x\" }\n"
                           "[noise]\ngain = 0\n"  // the sensor's gain and the mass have one effect
                           "[fit]\nfree = [\"mass\", \"damping\"]\n"
                           "[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n"
                           "[[run]]\nfile = \"b.csv\"\nuse = \"hold_out\"\n"));
  const Comparison comparison = compare_campaign(data);
  CHECK(comparison.is_adequate() == is_free);
  if (!is_free) return;
  const std::vector<double>& found = comparison.baseline.calibrated.values;
  CHECK(found[0] == Approx(4.0).epsilon(test::tolerance(2e-3)));
  CHECK(found[1] == Approx(3.0).epsilon(test::tolerance(1e-2)));
}

}  // namespace
}  // namespace strut
