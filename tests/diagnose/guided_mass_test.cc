// A rig that is named only in model/rig and model_files is compared and calibrated like every
// other.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "diagnose/compare/compare.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::TemporaryFolder;

constexpr double kMass = 10.0, kStiffness = 3400.0, kDamping = 42.0;  // kg, N/m, N s/m
constexpr double kFriction = 1.2, kSpeed = 0.005;                     // N, m/s
constexpr double kNoise = 1e-5;                                       // m

/// Heun's method with a step of 0.05 ms, independent of the program.
std::string record(double amplitude, std::uint64_t seed) {
  constexpr double kDuration = 6.0, kStep = 5e-5;
  test::QuarterTruth road;
  road.amplitude = amplitude;
  const auto base = [&](double t) { return test::calc_test_road(road, t, kDuration); };
  double z = 0.0, v = 0.0;
  const auto accelerate = [&](double t, double position, double velocity) {
    const double base_rate = (base(t + 1e-6) - base(t - 1e-6)) / 2e-6;
    return (kStiffness * (base(t) - position) + kDamping * (base_rate - velocity) -
            kFriction * std::tanh(velocity / kSpeed)) /
           kMass;
  };
  std::string text = "t,base,z\n";
  for (int i = 0; i * kStep <= kDuration; ++i) {
    const double t = i * kStep;
    if (i % 100 == 0) {
      const double reading =
          z + kNoise * test::calc_test_normal(seed, 0, static_cast<std::uint64_t>(i));
      text += test::print_number(t) + "," + test::print_number(base(t)) + "," +
              test::print_number(reading) + "\n";
    }
    const double a = accelerate(t, z, v);
    const double ahead = v + kStep * a;
    const double b = accelerate(t + kStep, z + kStep * v, ahead);
    z += 0.5 * kStep * (v + ahead);
    v += 0.5 * kStep * (a + b);
  }
  return text;
}

CampaignData read_guided(const std::string& free) {
  const TemporaryFolder folder;
  folder.write("a.csv", record(3e-3, 1));
  folder.write("b.csv", record(2e-3, 2));
  folder.write("rig.toml",
               "type = \"guided_mass\"\nmass = 10\nstiffness = 3000\ndamping = 30\n"
               "guide_speed = 0.005\n");
  return read_campaign_data(folder.write(
      "campaign.toml",
      "model = \"rig.toml\"\n[columns]\ntime = { column = \"t\" }\n"
      "base_position = { column = \"base\" }\nposition = { column = \"z\", noise = 1e-5 }\n"
      "[fit]\nfree = " +
          free +
          "\n[[run]]\nfile = \"a.csv\"\nuse = \"fit\"\n"
          "[[run]]\nfile = \"b.csv\"\nuse = \"hold_out\"\n"));
}

TEST_CASE("The friction of a guide is found where it may be fitted", "[reference]") {
  const Comparison comparison =
      compare_campaign(read_guided("[\"stiffness\", \"damping\", \"guide_friction\"]"));
  CHECK(comparison.is_adequate());
  const std::vector<double>& found = comparison.baseline.calibrated.values;
  CHECK(found[0] == Approx(kStiffness).epsilon(test::tolerance(2e-3)));
  CHECK(found[1] == Approx(kDamping).epsilon(test::tolerance(0.01)));
  CHECK(found[2] == Approx(kFriction).epsilon(test::tolerance(0.01)));
}

TEST_CASE("A guided mass without its friction is not adequate", "[reference]") {
  const Comparison comparison = compare_campaign(read_guided("[\"stiffness\", \"damping\"]"));
  CHECK_FALSE(comparison.is_adequate());
  const ChannelComparison& position = comparison.runs[1].calibrated.channels[0];
  CHECK(position.chi2_per_reading > 5.0);
  REQUIRE(position.states.size() == 3);
  CHECK(position.states[0].state == "strut_deflection");
  CHECK(position.states[2].state == "velocity");
}

}  // namespace
}  // namespace strut
