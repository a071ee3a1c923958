// What the command line of `strut simulate` asks for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/case/load_case.h"
#include "jobs/case/run_file.h"
#include "sweep/choices.h"

namespace strut {

/// Share of --step with which a failed run is tried once more, to tell whether the step is to
/// blame.
inline constexpr double kRetryFraction = 0.125;

struct SimulateOptions {
  CaseSource source;
  std::filesystem::path output;
  std::filesystem::path report;  // folder; empty: none
  int integrator = 0;            // of kIntegrators
  IntegrateOptions integrate;
  double rate = 1000.0;  // Hz
  bool kinematics = false, json = false;
  bool force = false;  // may replace the output

  const std::string& integrator_name() const {
    return kIntegrators[static_cast<std::size_t>(integrator)];
  }
  const std::string& closure_name() const {
    return kClosures[static_cast<std::size_t>(integrate.closure)];
  }
  const std::string& spin_name() const { return kSpins[static_cast<std::size_t>(integrate.spin)]; }
};

/// Refuses a rate [Hz] at which the history of `duration` [s] would not fit into memory. Throws
/// InputError.
void check_rate(double rate, double duration);

/// Refuses a step so short that a run of `duration` [s] would not end. Throws InputError.
void check_step_count(const SimulateOptions& options, double duration);

/// The format of the output, which check_output_file() has let pass. Throws InputError,
/// EnvironmentError.
RunFormat check_output(const SimulateOptions& options);

}  // namespace strut
