// The integration that Python asks for.
#pragma once

#include <optional>
#include <string>

#include "model/kernel/simulation.h"

namespace strut {

/// Keyword arguments of a simulation; null: the default of the call.
struct IntegrationWords {
  std::optional<std::string> integrator, closure, spin;
  std::optional<double> step, coarse_step;
  bool events = true;
};

/// Defaults of `strut simulate`: RK4 at 1 ms, or `longest_step` [s], which its effects need;
/// Newton closure. Throws InputError.
SolverOptions read_single_run(const IntegrationWords& words, double longest_step);

/// Properties of many runs by which their default steps are chosen.
struct ManyKind {
  bool histories = false;
  double lowest_speed = 0.0;  // m/s
};

/// Defaults: tables; one side of a symmetric car; for histories RK4 at 1 ms, for snapshots alone
/// ABM4 at 1 ms with longer steps away from the bump, 10 ms from 10 m/s on, below it 4 ms, since
/// the spins of slow wheels are fast; or `longest_step` [s]. Throws InputError.
SolverOptions read_many_runs(const IntegrationWords& words, double longest_step,
                             const ManyKind& kind);

}  // namespace strut
