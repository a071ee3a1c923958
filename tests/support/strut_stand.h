// A strut on a stand that moves it sinusoidally: the force of a linear damper, known by hand.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/noise/noise_spectrum.h"

namespace strut::test {

inline constexpr double kStandDuration = 4.0, kStandInterval = 0.005;  // s
inline constexpr double kStandSigma = 1.5;                             // N
inline constexpr double kStandDamping = 1000.0;                        // N s/m

inline void add_run(const MeasuredRun& run, CampaignData& data) {
  CampaignRun entry;
  entry.name = run.name;
  data.campaign.runs.push_back(entry);
  data.tables.emplace_back();
  data.runs.push_back(run);
}

/// A run of `amplitude` [m] at `frequency` [Hz]; the force is read.
inline MeasuredRun make_stand_run(const std::string& name, double amplitude, double frequency) {
  RigSpec rig;
  rig.kind = RigKind::kStrutRig;
  rig.damping = kStandDamping;
  MeasuredRun run{name, Model(RigCase{rig, {}}), {}, {}};
  std::vector<double> motion;
  for (int i = 0; i * kStandInterval < kStandDuration; ++i) {
    run.times.push_back(i * kStandInterval);
    motion.push_back(amplitude * std::sin(2.0 * std::numbers::pi * frequency * i * kStandInterval));
  }
  run.setup.rig().inputs = {make_signal("displacement", run.times, motion, Interpolation::kSpline)};
  run.input_noise = {{}};
  run.channels = {
      {StrutRigChannel::kForce, kStandSigma, std::vector<double>(run.times.size(), 0.0)}};
  return run;
}

/// One run for each amplitude and frequency.
inline CampaignData make_stand(const std::vector<std::pair<double, double>>& motions) {
  CampaignData data;
  data.campaign.info = &get_rig_info(RigKind::kStrutRig);
  for (const auto& [amplitude, frequency] : motions) {
    add_run(make_stand_run("run_" + std::to_string(data.run_count()), amplitude, frequency), data);
  }
  return data;
}

inline NoiseSpectrum make_white_noise(const MeasuredRun& run) {
  NoiseSpectrum noise;
  noise.samples = run.times.size();
  noise.interval = kStandInterval;
  noise.sigma = {kStandSigma};
  return noise;
}

}  // namespace strut::test
