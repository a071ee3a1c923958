// The cases of `strut bench`: one maneuver, with different springs and dampers in each lane.
#pragma once

#include <string>
#include <vector>

#include "jobs/case/load_case.h"

namespace strut {

/// Integrator settings with which cases are run.
struct BenchSetting {
  std::string label;  // "lanes"
  std::string text;   // "rk4 1 ms, ..."
  IntegrateOptions options;
  bool in_lanes = true;
};

/// "rk4 1 ms, newton, exponential spin, events located, one side"
std::string describe(const IntegrateOptions& options);

/// Prepared cases whose springs and dampers vary over the ranges of the paper; the nominal one
/// first.
struct BenchCases {
  std::vector<PreparedCase> cases;
  double duration = 0.0;            // s
  double seconds_to_prepare = 0.0;  // s a case
  /// Reference of each case: acceleration of the body by CVODE [m/s^2], sampled at kBenchRate.
  std::vector<std::vector<double>> acceleration;
};
inline constexpr double kBenchRate = 1000.0;  // Hz

/// Reads the files, prepares `count` cases and integrates their references. Throws InputError.
BenchCases make_bench_cases(const CaseSource& source, int count);

/// Runs all cases once in lanes, or, with a scalar setting, only the nominal case.
LaneResults run_cases(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting,
                      const SamplePlan& plan);

/// Error of the body acceleration: rms of its difference to the reference, relative to the rms of
/// the reference; maximum over the cases that run_cases() runs. Infinite if one fails.
double measure_error(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting);

/// Right-hand sides of a run, of a lane together with those beside it.
double count_right_hand_sides(const BenchCases& bench, const Kernel& kernel,
                              const BenchSetting& setting);

/// The fixed settings, all of the whole car but the last: double, lanes, lanes_tabulated,
/// lanes_one_side.
std::vector<BenchSetting> list_standard_settings();

/// Candidates for the fastest setting; one side of a car that moves symmetrically.
std::vector<BenchSetting> list_fast_settings(bool quick);

}  // namespace strut
