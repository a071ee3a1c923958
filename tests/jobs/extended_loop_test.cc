// The loop of examples/extended_loop: measured data, the diagnosis' extended model, a sweep of it,
// a network that identifies what the plain model's cannot.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/jobs/parse_json.h"
#include "tests/jobs/run_program.h"

namespace strut {
namespace {

using test::run_program;

const std::string kExample = STRUT_SOURCE_DIR "/examples/extended_loop/";
const std::vector<std::string> kParameters = {"front_stiffness", "front_damping", "rear_stiffness",
                                              "rear_damping"};

std::map<std::string, double> read_truth() {
  std::ifstream file(kExample + "truth.csv");
  std::map<std::string, double> truth;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    truth[line.substr(0, line.find(','))] = std::stod(line.substr(line.rfind(',') + 1));
  }
  return truth;
}

/// Largest and mean relative error of a network's answer to the record.
struct Errors {
  double largest = 0.0, mean = 0.0;
};

Errors calc_errors(const test::TemporaryFolder& folder, const std::string& model) {
  const test::Outcome outcome =
      run_program("identify " + std::string(folder / (model + ".h5")) + " " +
                  std::string(folder / "record.csv") + " --extrapolate --json");
  INFO(outcome.messages);
  REQUIRE(outcome.code <= 1);
  // The plain network says that the record lies outside of what it was trained on.
  CHECK((outcome.code == 1) == (model == "plain"));
  const auto json = test::parse_json(outcome.out);
  const auto truth = read_truth();
  Errors errors;
  for (const std::string& name : kParameters) {
    const double value = json.get<double>("parameters." + name + ".value");
    const double error = std::abs(value / truth.at(name) - 1.0);
    errors.largest = std::max(errors.largest, error);
    errors.mean += error / static_cast<double>(kParameters.size());
  }
  return errors;
}

/// Runs other commands with the extended model in place of a model file.
void check_commands(const test::TemporaryFolder& folder) {
  const auto at = [&](const std::string& name) { return std::string(folder / name); };
  const std::string model = at("diagnosis/extended.toml"), maneuver = at("middle_22.toml");
  const test::Outcome simulated =
      run_program("simulate " + model + " " + maneuver + " -o " + at("simulated.csv"));
  INFO(simulated.messages);
  CHECK(simulated.code == 0);
  const test::Outcome without =
      run_program("simulate " + model + " " + maneuver + " --set rear_damper_asymmetry=0 -o " +
                  at("without.csv"));
  CHECK(without.code == 0);
  CHECK(test::read_text(at("simulated.csv")) != test::read_text(at("without.csv")));
  CHECK(run_program("plan " + at("extended_sweep.toml") + " --dry-run").code == 0);

  const auto fit = [&](const std::string& vehicle) {
    const test::Outcome fitted = run_program(
        "identify " + vehicle + " " + at("record.csv") + " --maneuver " + maneuver +
        " --window 0.3:2.2 --noise imu_acceleration_z=0.04 --noise imu_rate_y=0.003 --json");
    INFO(fitted.messages);
    REQUIRE(fitted.code <= 1);
    return test::parse_json(fitted.out).get<double>("parameters.rear_damping.value");
  };
  const double truth = read_truth().at("rear_damping");
  CHECK(std::abs(fit(model) - truth) < 0.5 * std::abs(fit(at("model.toml")) - truth));

  std::string campaign = test::read_text(at("campaign.toml"));
  campaign.replace(campaign.find("model.toml"), 10, "diagnosis/extended.toml");
  const auto compare = [&](const std::string& file) {
    const test::Outcome outcome = run_program("compare " + file + " --json -o " + file + ".out");
    INFO(outcome.messages);
    REQUIRE(outcome.code == 0);
    return test::parse_json(outcome.out)
        .get_child("runs")
        .back()
        .second.get<double>("nominal.channels.rear_left_suspension_deflection.rms");
  };
  CHECK(compare(folder.write("again.toml", campaign)) < 0.3 * compare(at("campaign.toml")));
}

TEST_CASE("The extended model's network identifies what the plain model's cannot",
          "[regression][slow]") {
  const test::TemporaryFolder folder;
  const test::Outcome loop =
      test::run_shell(kExample + "run_loop " STRUT_PROGRAM " " + std::string(folder / "."));
  INFO(loop.messages << loop.out);
  REQUIRE(loop.code == 0);
  const auto verdict = test::parse_json(test::read_text(folder / "diagnosis" / "verdict.json"));
  const auto& cause = verdict.get_child("causes").front().second;
  CHECK(cause.get<std::string>("effect") == "damper_asymmetry");
  CHECK(cause.get<std::string>("place") == "rear");
  const Errors plain = calc_errors(folder, "plain"), extended = calc_errors(folder, "extended");
  INFO("largest " << plain.largest << ", " << extended.largest << "; mean " << plain.mean << ", "
                  << extended.mean);
  CHECK(extended.largest < 0.5 * plain.largest);
  CHECK(extended.mean < 0.5 * plain.mean);
  // The example's table says the same.
  CHECK(test::read_text(folder / "errors.txt").find("rear_damping") != std::string::npos);
  check_commands(folder);
}

}  // namespace
}  // namespace strut
