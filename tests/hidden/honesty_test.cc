// Diagnoses of trials with a known answer: mirrored, scaled and noise-free truths.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/hidden/ablation.h"
#include "tests/hidden/campaign_files.h"
#include "tests/hidden/verdicts.h"
#include "tests/jobs/run_program.h"
#include "tests/support/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

/// The verdict's file as the program wrote it.
std::filesystem::path diagnose(const std::filesystem::path& campaign) {
  const std::filesystem::path out = campaign.parent_path() / "out";
  const test::Outcome outcome =
      test::run_program("diagnose " + campaign.string() + " --threads 1 -o " + out.string());
  INFO(outcome.messages);
  REQUIRE(outcome.code == 0);
  return out / "verdict.json";
}

/// A trial of a worn suspension with these faults; clocks and sensors are without offset.
Trial make_trial(const Kit& kit, const std::vector<FaultSetting>& faults) {
  Trial trial;
  trial.seed = 7;
  trial.truth = make_nominal_truth(kit);
  trial.truth.faults = faults;
  for (const FaultSetting& s : faults) trial.faults.push_back({s, {}});
  trial.clocks.assign(kit.runs.size(), {0.0, 0.0, kit.jitter});
  trial.bias.assign(kit.sensors.size(), 0.0);
  return trial;
}

std::filesystem::path write_campaign(const Kit& kit, const Trial& trial,
                                     const test::TemporaryFolder& folder) {
  write_trial(kit, trial, folder / "x");
  return std::filesystem::path(folder / "x") / "trials" / make_trial_name(trial.seed) /
         "campaign.toml";
}

/// One crossing for fitting and level ground, on a smooth road: a third of a diagnosis' time.
Verdict diagnose_small_car(Kit kit, Trial trial) {
  ablate(Ablation::kOneCrossing, kit, trial);
  const test::TemporaryFolder folder;
  return read_verdict(diagnose(write_campaign(kit, trial, folder)));
}

void scale_parameters(const Kit& kit, double scale, Truth& truth) {
  for (std::size_t i = 0; i < kit.parameters.size(); ++i) {
    if (!kit.parameters[i].survey) truth.factors[i] *= scale;
  }
}

std::string describe(const Verdict& v) {
  std::string text = v.verdict;
  for (const Claim& c : v.causes) text += " " + c.effect + "@" + c.place;
  return text;
}

}  // namespace

TEST_CASE("Hidden data: the same fault at the other axle moves the answer there", "[slow]") {
  const Kit kit = make_kit("car");
  const std::array<const char*, 2> places = {"front", "rear"};
  for (int axle = 0; axle < 2; ++axle) {
    Trial trial = make_trial(kit, {{Fault::kAsymmetry, axle, 0.1, 0.0}});
    trial.truth.roughness = 1e-6;
    const test::TemporaryFolder folder;
    const Verdict v = read_verdict(diagnose(write_campaign(kit, trial, folder)));
    INFO(describe(v));
    REQUIRE(!v.causes.empty());
    CHECK(v.causes.front().effect == "damper_asymmetry");
    CHECK(v.causes.front().place == places[static_cast<std::size_t>(axle)]);
    for (const Claim& c : v.causes) CHECK(c.place != places[static_cast<std::size_t>(1 - axle)]);
  }
}

TEST_CASE("Hidden data: a car whose masses, springs and dampers are all 5 % larger is the same car",
          "[slow]") {
  const Kit kit = make_kit("car");
  Trial trial = make_trial(kit, {});
  trial.truth.force_scale = 1.05;
  const Verdict v = diagnose_small_car(kit, trial);
  INFO(describe(v));
  CHECK(v.verdict == "adequate");
  // Ratios are relative to the file's mass.
  for (const KitParameter& p : kit.parameters) {
    if (p.survey) continue;
    INFO(p.name);
    const Estimate& e = v.after.at(p.name);
    CHECK(e.value == Approx(p.nominal).epsilon(tolerance(0.01)));
    CHECK(e.high < 1.05 * p.nominal);
  }
}

TEST_CASE("Hidden data: of a quarter car without a weighed mass only ratios are told", "[slow]") {
  Kit kit = make_kit("quarter_car");
  Trial trial = make_trial(kit, {});
  scale_parameters(kit, 1.05, trial.truth);
  const test::TemporaryFolder weighed;
  const Verdict anchored = read_verdict(diagnose(write_campaign(kit, trial, weighed)));
  INFO(describe(anchored));
  CHECK(anchored.verdict == "adequate");
  for (const KitParameter& p : kit.parameters) {
    INFO(p.name);
    // The weighed mass, 5 % too small, takes all others with it: to 0.5 % (1 sigma of the weight).
    CHECK(anchored.after.at(p.name).value == Approx(p.nominal).epsilon(tolerance(0.015)));
  }
  for (KitParameter& p : kit.parameters) p.prior = 0.0;
  const test::TemporaryFolder unweighed;
  const auto path = diagnose(write_campaign(kit, trial, unweighed));
  const Verdict free = read_verdict(path);
  INFO(describe(free));
  CHECK(free.verdict == "adequate");
  const auto open = read_json(path).get_child("not_identifiable");
  REQUIRE(open.size() == 1);
  for (const KitParameter& p : kit.parameters) {
    CHECK_THAT(open.front().second.data(), Catch::Contains(p.name));
  }
}

namespace {

/// A quarter car's runs as the program itself simulates them, with `--set` words; HDF5, so that no
/// digit is lost.
std::filesystem::path simulate_campaign(const test::TemporaryFolder& folder,
                                        const std::string& setting) {
  folder.write("model.toml",
               "type = \"quarter_car\"\nsprung_mass = 2.45\nunsprung_mass = 1.0\n"
               "stiffness = 900.0\ndamping = 7.5\ntire_stiffness = 1250.0\ntire_damping = 5.0\n"
               "tire_contact = \"bilateral\"\ngravity = 9.81\n");
  std::string runs;
  for (const auto& [name, amplitude] : {std::pair{"fit", "0.002"}, {"hold_out", "0.0013"}}) {
    folder.write(std::string(name) + ".toml",
                 std::string("duration = 6.0\n[input.road_position]\nshape = \"chirp\"\n"
                             "amplitude = ") +
                     amplitude + "\nbegin_frequency = 0.8\nend_frequency = 9.0\n");
    const test::Outcome outcome = test::run_program(
        "simulate " + std::string(folder / "model.toml") + " " +
        std::string(folder / (std::string(name) + ".toml")) + " --rate 1000 --step 2.5e-4 " +
        setting + " -o " + std::string(folder / (std::string(name) + ".h5")));
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    runs += std::string("[[run]]\nfile = \"") + name + ".h5\"\nuse = \"" + name + "\"\n";
  }
  return folder.write("campaign.toml",
                      "model = \"model.toml\"\n[columns]\ntime = {}\n"
                      "road_position = { role = \"input\", smooth = 0.0 }\nunsprung_position = {}\n"
                      "sprung_position = {}\n[fit]\nfree = [\"unsprung_mass\", \"stiffness\", "
                      "\"damping\", \"tire_stiffness\", \"tire_damping\"]\n" +
                          runs);
}

}  // namespace

TEST_CASE("Hidden data: without noise and in the catalogue's form the answer is exact", "[slow]") {
  struct Known {
    std::string effect, parameter, setting;
    double value, accuracy;
  };
  // Simulated with steps of 0.25 ms, diagnosed with 2 ms: a force that jumps in slope with the sign
  // of the velocity costs Runge and Kutta's method an order.
  const std::vector<Known> list = {
      {"damper_asymmetry", "asymmetry", "--set damper_asymmetry=0.3", 0.3, 2e-5},
      {"progressive_spring", "cubic", "--set progressive_spring=4000", 4000.0, 1e-6}};
  for (const Known& known : list) {
    INFO(known.effect);
    const test::TemporaryFolder folder;
    const Verdict v = read_verdict(diagnose(simulate_campaign(folder, known.setting)));
    INFO(describe(v));
    REQUIRE(v.causes.size() == 1);
    CHECK(v.causes.front().effect == known.effect);
    const double error = v.causes.front().parameters.at(known.parameter).value / known.value - 1.0;
    CHECK(std::fabs(error) < tolerance(known.accuracy));
    // Beside the truth nothing has a gain worth a probability.
    for (const Claim& c : v.runners_up) CHECK(c.probability < 1e-6);
    CHECK(v.after.at("stiffness").value == Approx(900.0).epsilon(tolerance(1e-6)));
    CHECK(v.after.at("damping").value == Approx(7.5).epsilon(tolerance(1e-6)));
  }
}

}  // namespace strut::hidden
