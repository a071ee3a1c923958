// Measurements for tests of fits, made without what fits use: CVODE or another step, loops closed
// by Newton, sampled by the integrator itself at the measuring clock's own instants.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "estimate/fit.h"
#include "estimate/nuisances.h"
#include "model_files/parameters.h"
#include "tests/support/campaign_files.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut::test {

inline const std::vector<std::string>& suspension_names() {
  static const std::vector<std::string> names{"front_stiffness", "front_damping", "rear_stiffness",
                                              "rear_damping"};
  return names;
}

/// Errors that the sensors add to the truth.
struct Distortion {
  double hit_time = 0.0;                            // s, simulated less measured time
  double acceleration_bias = 0.0, rate_bias = 0.0;  // added to the readings
  double noise = 0.0;                               // in units of the channels' sigma
  std::uint64_t seed = 1;
};

inline LaneResults simulate_truth(const Case& truth, double rate, bool cvode) {
  CasePreparer preparer;
  const PreparedCase prepared = preparer.prepare(truth);
  SamplePlan plan = make_plan(1.0 / rate);
  plan.snapshot = false;
  if (cvode) return run_cvode(prepared, {}, plan);
  IntegrateOptions options;
  options.step.step = 0.25e-3;
  return list_kernels().front().run_scalar(prepared, options, plan);
}

/// The vertical accelerometer and the pitch gyroscope at 200 Hz; the setup stays `known`.
inline MeasuredRun measure(const Case& known, const Case& truth, const Distortion& distortion,
                           bool cvode = false) {
  constexpr double kRate = 200.0;
  const LaneResults results = simulate_truth(truth, kRate, cvode);
  MeasuredRun run{"truth", known, {}, {}};
  for (int i = 0; i < results.sample_count; ++i) {
    run.times.push_back(i / kRate - distortion.hit_time);
  }
  const std::pair<int, double> sensors[] = {{CarChannel::kImuAccelerationZ, 0.02},
                                            {CarChannel::kImuRateY, 1e-3}};
  for (const auto& [channel, sigma] : sensors) {
    const bool rate = channel == CarChannel::kImuRateY;
    MeasuredChannel c{channel, sigma, {}};
    for (int i = 0; i < results.sample_count; ++i) {
      const auto place = static_cast<std::uint64_t>(i);
      c.values.push_back(results.get_sample(i, channel) +
                         (rate ? distortion.rate_bias : distortion.acceleration_bias) +
                         distortion.noise * sigma *
                             calc_test_normal(distortion.seed, rate ? 1 : 0, place));
    }
    run.channels.push_back(std::move(c));
  }
  return run;
}

inline std::vector<Unknown> make_suspension(const std::vector<MeasuredRun>& runs) {
  std::vector<Unknown> unknowns;
  for (const std::string& name : suspension_names()) unknowns.push_back(make_parameter(runs, name));
  return unknowns;
}

/// The suspension's parameters first, then all nuisances.
inline std::vector<Unknown> make_all_unknowns(const std::vector<MeasuredRun>& runs) {
  std::vector<Unknown> unknowns = make_suspension(runs);
  for (Unknown& u : make_nuisances(runs, {}, unknowns)) unknowns.push_back(std::move(u));
  return unknowns;
}

/// The paper's car and bump, until both axles have crossed it and come to rest for the most part.
inline Case make_bump_case() {
  Case c = make_paper_case();
  c.maneuver.duration = 1.3;
  return c;
}

/// The same, half worn: where fits start.
inline Case make_known_case() {
  Case c = make_bump_case();
  set_parameter(c, "front_stiffness", 37750.0);
  set_parameter(c, "front_damping", 1890.0);
  set_parameter(c, "rear_stiffness", 32750.0);
  set_parameter(c, "rear_damping", 1890.0);
  return c;
}

}  // namespace strut::test
