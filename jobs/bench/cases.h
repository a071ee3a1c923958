// What `strut bench` runs: the paper's maneuver, a little different in every lane.
#pragma once

#include <string>
#include <vector>

#include "jobs/case/load_case.h"

namespace strut {

/// A way to run cases.
struct BenchSetting {
  std::string label;  // "lanes"
  std::string text;   // "rk4 1 ms, ..."
  IntegrateOptions options;
  bool in_lanes = true;
};

/// Prepared cases that differ in springs and dampers over the paper's ranges, the nominal one
/// first.
struct BenchCases {
  std::vector<PreparedCase> cases;
  double duration = 0.0;            // s
  double seconds_to_prepare = 0.0;  // s a case
  /// m/s^2, each case's body by CVODE, sampled at kBenchRate.
  std::vector<std::vector<double>> acceleration;
};
inline constexpr double kBenchRate = 1000.0;  // Hz

/// Reads, prepares and integrates the references. Throws InputError.
BenchCases make_bench_cases(const CaseSource& source, int count);

/// Runs all cases once in lanes; in the scalar setting the nominal case alone.
LaneResults run_cases(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting,
                      const SamplePlan& plan);

/// rms of a case's body acceleration minus its reference's, over the reference's rms: the worst of
/// the cases that run_cases runs. Infinite where one fails.
double measure_error(const BenchCases& bench, const Kernel& kernel, const BenchSetting& setting);

/// The single-core figures other than the fastest: double, lanes, lanes_tabulated.
std::vector<BenchSetting> list_standard_settings();

/// Candidates for the fastest setting.
std::vector<BenchSetting> list_fast_settings(bool quick);

}  // namespace strut
