// Options of `strut simulate`.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "jobs/case/load_case.h"
#include "jobs/cli/arguments.h"
#include "jobs/simulate/run_file.h"
#include "sweep/choices.h"

namespace strut {

/// Step of the retry of a failed run, as a fraction of --step: the retry tells whether the step was
/// too long.
inline constexpr double kRetryFraction = 0.125;

struct SimulateOptions {
  CaseSource source;
  std::filesystem::path output;
  std::filesystem::path report;  // folder; empty: none
  std::filesystem::path beside;  // another run, drawn over this one in the report; empty: none
  Integrator integrator = Integrator::kRk4;
  IntegrateOptions integrate;
  bool chose_step = false;            // --step is given
  double rate = 1000.0;               // Hz
  std::vector<std::string> channels;  // in the output beside the time; empty: all
  bool kinematics = false, json = false;
  bool force = false;  // the output may be replaced

  const char* integrator_name() const { return find_name(kIntegrators, integrator); }
  const char* closure_name() const { return find_name(kClosures, integrate.closure); }
  const char* spin_name() const { return find_name(kSpins, integrate.spin); }
};

/// Reads and checks all options but those that depend on the car and the maneuver. Throws
/// InputError.
SimulateOptions read_simulate_options(const Arguments& arguments);

/// Throws InputError if one of the options `names` is given; `reason` says why they have no effect.
void refuse_options(const Arguments& arguments, std::initializer_list<const char*> names,
                    const std::string& reason);

/// Throws InputError if the history of `duration` [s] at `rate` [Hz] would not fit into memory.
void check_rate(double rate, double duration);

/// Throws InputError if a run of `duration` [s] would take too many steps.
void check_step_count(const SimulateOptions& options, double duration);

/// The options with the steps that a model needs whose effects allow at most `longest` [s]: halves
/// the default step, and warns about longer ones that were asked for.
SimulateOptions adapt_steps(SimulateOptions options, double longest);

/// Checks the output file and returns its format. Throws InputError, EnvironmentError.
RunFormat check_output(const SimulateOptions& options);

}  // namespace strut
