// strut_loop_data: the measured data of examples/extended_loop, a car with a worn suspension whose
// rear dampers are harder in rebound than in compression. Knows nothing of the program.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/hidden/campaign_files.h"

namespace strut::hidden {
namespace {

/// The car kit with a body's inertial sensor and ride heights, on three crossings.
Kit make_loop_kit() {
  Kit kit = make_kit("car");
  std::erase_if(kit.sensors, [](const Sensor& s) {
    return s.channel != "imu_acceleration_z" && s.channel != "imu_rate_y" &&
           s.channel.find("deflection") == std::string::npos;
  });
  std::erase_if(kit.runs, [](const RunPlan& run) {
    return run.name != "middle_20" && run.name != "middle_30" && run.name != "middle_22";
  });
  for (RunPlan& run : kit.runs) run.duration = 2.5;
  kit.rate = 250.0;
  return kit;
}

Trial make_loop_trial(const Kit& kit) {
  Trial trial;
  trial.category = Category::kOne;
  trial.truth = make_nominal_truth(kit);
  // In the kit's order: stiffness and damping of the axles, mass, height and length of three bumps.
  trial.truth.factors = {0.93, 0.85, 0.88, 0.78, 1.002, 1.0, 1.0, 1.009, 0.993, 1.0, 1.0};
  trial.truth.faults = {{Fault::kAsymmetry, 1, 0.3, 0.0}};
  trial.truth.speed_error = {0.004, -0.003, 0.002};
  trial.truth.roughness = 1e-6;
  trial.truth.seed = trial.seed;
  trial.faults = {{trial.truth.faults.front(), {}}};
  trial.clocks = {{2e-3, 2e-5, kit.jitter}, {-3e-3, -1e-5, kit.jitter}, {1e-3, 1e-5, kit.jitter}};
  trial.bias = {0.2, -0.01, 1e-3, -2e-3, 1.5e-3, -1e-3};
  return trial;
}

}  // namespace

int run(const std::vector<std::string>& words) {
  if (words.size() != 1) {
    std::cerr << "Usage: strut_loop_data DIR\n";
    return 2;
  }
  const Kit kit = make_loop_kit();
  write_trial(kit, make_loop_trial(kit), words[0]);
  return 0;
}

}  // namespace strut::hidden

int main(int argc, char** argv) {
  try {
    return strut::hidden::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    std::cerr << "strut_loop_data: " << e.what() << "\n";
    return 3;
  }
}
