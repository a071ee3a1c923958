// Options of simulated readings, for fits, derivatives and bounds.
#pragma once

#include "model/kernel/simulation.h"

namespace strut {

/// RK4 with steps of 1 ms, 4 ms away from the bump, and located contact events; one side of a car
/// that moves symmetrically. Corners are tabulated, which takes half the time of closing the loops,
/// changes estimates by less than 1e-6 sigma, and lets cases with different hardpoints share lanes.
inline SolverOptions make_fit_integration() {
  SolverOptions request;
  request.options.closure = Closure::kTable;
  request.options.symmetry = true;
  request.options.step.coarse_step = 4e-3;
  return request;
}

struct LinearizeOptions {
  /// Integration of a car on a road.
  SolverOptions integrate = make_fit_integration();
  /// Sampling rate of a car's simulation [1/s], between whose samples readings are interpolated.
  /// The interpolation error over a bump at 20 m/s is a tenth of a standard deviation of MEMS
  /// sensors at 1000/s, 3 % of one at 2000/s.
  double rate = 2000.0;
  /// Maximum step of a run that recorded inputs drive [s], where its model needs no shorter one
  /// (model/longest_step.h).
  double longest_step = 2e-3;
  /// Step h of the central differences as a fraction of the scale. Short, since readings near a
  /// contact event are kinked in the unknowns: at 1e-4 the speed moves an event across them. The
  /// rounding error is 1e-7.
  double relative_step = 1e-5;
  int threads = 1;  // results do not depend on it
};

}  // namespace strut
