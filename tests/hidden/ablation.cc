#include "tests/hidden/ablation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace strut::hidden {
namespace {

constexpr std::array<const char*, 5> kNames = {"none", "no_roughness", "no_deflection", "body_only",
                                               "one_crossing"};

bool tells_deflection(const Sensor& sensor) {
  return sensor.channel.find("suspension_deflection") != std::string::npos ||
         sensor.channel == "unsprung_position";
}

bool is_of_body(const Sensor& sensor) {
  return sensor.channel.rfind("imu_", 0) == 0 || sensor.channel == "sprung_position";
}

/// The most informative run for a car, a quarter car, and a strut.
bool is_kept_alone(const RunPlan& run) {
  return run.name == "middle_20" || run.name == "rough_A" || run.name == "medium";
}

bool is_lost(const Kit& kit, const FaultSetting& setting) {
  return get_info(setting.fault).where == Where::kChannel &&
         !kit.sensors[static_cast<std::size_t>(setting.place)].recorded;
}

void drop_lost_faults(const Kit& kit, Trial& trial) {
  std::erase_if(trial.faults, [&](const HiddenFault& f) { return is_lost(kit, f.setting); });
  std::erase_if(trial.truth.faults, [&](const FaultSetting& s) { return is_lost(kit, s); });
  if (trial.category == Category::kTwo && trial.faults.size() == 1) trial.category = Category::kOne;
  if (trial.faults.empty()) trial.category = Category::kNone;
}

}  // namespace

Ablation make_ablation(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw std::invalid_argument(
        "ablation '" + name +
        "': must be none, no_roughness, no_deflection, body_only or one_crossing");
  }
  return static_cast<Ablation>(found - kNames.begin());
}

void ablate(Ablation ablation, Kit& kit, Trial& trial) {
  if (ablation == Ablation::kNoRoughness) trial.truth.roughness = 0.0;
  for (Sensor& s : kit.sensors) {
    if (ablation == Ablation::kNoDeflection && tells_deflection(s)) s.recorded = false;
    if (ablation == Ablation::kBodyOnly && !s.input && !is_of_body(s)) s.recorded = false;
  }
  for (RunPlan& run : kit.runs) {
    const bool alone = is_kept_alone(run) || run.excitation == Excitation::kFlat || !run.fit;
    if (ablation == Ablation::kOneCrossing && !alone) run.recorded = false;
  }
  const auto gives_out = [](const Sensor& s) { return s.recorded && !s.input; };
  if (std::none_of(kit.sensors.begin(), kit.sensors.end(), gives_out)) {
    throw std::invalid_argument("kit " + kit.name + ": the ablation leaves no sensor");
  }
  drop_lost_faults(kit, trial);
}

}  // namespace strut::hidden
