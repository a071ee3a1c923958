// The settings that a sweep file leaves open, which `strut plan` chooses once, by counts of
// operations and measured errors, never by a clock, and the plan keeps.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "sweep/facts.h"
#include "sweep/plan.h"
#include "sweep/request.h"

namespace strut {

/// Smallest bound of the error for which there are candidates.
inline constexpr double kFinestAccuracy = 1e-7;

/// The measurement by which the integrator was chosen.
struct IntegratorChoice {
  int cases = 0;  // on which errors were measured; 0: none has a result, and the default stands
  /// Largest error of the chosen setting over the cases and channels recorded; infinite where none
  /// of the candidates is stable, and the default stands.
  double error = std::numeric_limits<double>::infinity();
};

/// Chooses what `request` leaves open.
///
/// The integrator is the candidate with the fewest right-hand sides, counted from its steps, whose
/// error is at most request.accuracy (or else the most accurate), that is stable, and has no longer
/// step than the effects need. The error of a recorded channel on a few cases of this sweep is its
/// difference from CVODE at tolerance 1e-12 with Newton's closure (of a snapshot; of a history the
/// rms over the samples), relative to the range over which the channel moves in the run.
///
/// The shards get so many cases that each is some seconds of one core's work, at most
/// request.shard_cases. Returns nothing where the integrator is given. Throws InputError as Plan
/// does.
std::optional<IntegratorChoice> choose_settings(SweepRequest& request);

/// Error of a given step, largest over a few cases of the sweep and the channels recorded: the
/// difference from a quarter of the step, everywhere, relative to the range over which the channel
/// moves in the run. Infinite where only the shorter step has a result; nothing for CVODE, or where
/// no case has one.
std::optional<double> measure_step_error(const SweepRequest& request);

/// The plan of a sweep file, with the choices that it leaves open made. Throws InputError.
Plan make_plan(const std::filesystem::path& sweep);

/// Takes the settings that `request` leaves open from the facts of its plan. Throws InputError
/// where those are none that `strut plan` chooses.
void adopt_settings(const Facts& plan, SweepRequest& request);

/// "abm4 1 ms (10 ms off the bump), table": the integrator of a sweep, for messages.
std::string describe_integrator(const SolverOptions& integrate);

}  // namespace strut
