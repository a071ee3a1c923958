// Derivatives of every channel with respect to the parameters of a grid, along the whole crossing
// of the bump.
//
// Central differences of simulations in lockstep lanes: base, base +/- h and base +/- h/2 in each
// parameter. The instants are positions, not times: the rear wheels' mean forward position ahead of
// the bump's center, as for the snapshot (docs/identifiability.md). Each run is interpolated at its
// own time of passage, which gives dy/dp|t - (dy/dt) (dx/dp) / (dx/dt) without a differentiation in
// time.
#pragma once

#include <string>
#include <vector>

#include "base/math/grid.h"
#include "model/car/case.h"
#include "model/kernel/simulation.h"

namespace strut {

/// One parameter of the Jacobian.
struct SensitivityParameter {
  std::string name, unit;
  double base = 0.0;
  double scale = 0.0;  // 100 %: |base|, or half the axis's extent where that is larger
  double step = 0.0;   // h of the central difference
};

/// Derivatives at one position.
struct Instant {
  double offset = 0.0;           // rear wheels ahead of the bump's center [m]
  double time = 0.0;             // of the base run [s]
  std::vector<double> jacobian;  // [channel][parameter], channel unit per parameter unit
};

struct Sensitivity {
  std::vector<SensitivityParameter> parameters;
  Instant snapshot;               // at the request's offset, from the integrator's own event
  std::vector<Instant> instants;  // samples of the base run at positions that every run passes
  double rate = 0.0;              // 1/s, of the instants
  /// [channel][parameter]: rms over the instants of 4/3 (J(h) - J(h/2)), the leading error of J(h),
  /// relative to the rms of J(h). Zero for a curve of zeros.
  std::vector<double> error;

  double get(const Instant& instant, int channel, std::size_t parameter) const {
    return instant.jacobian[static_cast<std::size_t>(channel) * parameters.size() + parameter];
  }
};

struct SensitivityOptions {
  double rate = 1000.0;  // 1/s, of the instants
  /// h as a fraction of the parameter's scale. Truncation falls with h^2; rounding and the error of
  /// located contact events grow with 1/h. At 1e-4 both are below 2e-5 for the paper's sweep.
  double relative_step = 1e-4;
  SolverOptions integrate;  // default: RK4 1 ms, Newton closure, contact events located
};

/// Calculates the Jacobian of all car channels at `base` with respect to the axes' parameters. A
/// curve that is rounding error (its half-step error exceeds half of its size) is set to zero.
/// Throws InputError where a run is infeasible, fails, or never reaches the snapshot's line.
Sensitivity calc_sensitivity(const Case& base, const std::vector<Axis>& axes, double offset,
                             const SensitivityOptions& options);

}  // namespace strut
