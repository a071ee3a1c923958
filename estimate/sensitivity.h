// Derivatives of every channel by the parameters of a grid, all the way across the bump.
//
// Central differences of simulations in lockstep lanes: base, base +- h and base +- h/2 in each
// parameter. The instants are places, not times: the rear wheels' mean forward position ahead of
// the bump's center, as the snapshot is taken (docs/identifiability.md). So each run is
// interpolated at its own time of passage, which is dy/dp|t - (dy/dt) (dx/dp) / (dx/dt) without the
// differentiation in time.
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

/// Derivatives at one place.
struct Instant {
  double offset = 0.0;           // m, rear wheels ahead of the bump's center
  double time = 0.0;             // s, at the base point
  std::vector<double> jacobian;  // [channel][parameter], channel unit per parameter unit
};

struct Sensitivity {
  std::vector<SensitivityParameter> parameters;
  Instant snapshot;               // at the request's offset, from the integrator's own event
  std::vector<Instant> instants;  // one per sample of the base run that every run passes
  double rate = 0.0;              // 1/s, of the samples
  /// [channel][parameter]: rms over the instants of 4/3 (J(h) - J(h/2)), the leading error of J(h),
  /// relative to the rms of J(h). Zero where the curve is.
  std::vector<double> error;

  double get(const Instant& instant, int channel, std::size_t parameter) const {
    return instant.jacobian[static_cast<std::size_t>(channel) * parameters.size() + parameter];
  }
};

struct SensitivityOptions {
  double rate = 1000.0;  // 1/s, of the instants
  /// h as a share of the parameter's scale. Truncation falls with h^2, rounding and the residue of
  /// located contact events grow with 1/h; at 1e-4 both are below 2e-5 for the paper's sweep.
  double relative_step = 1e-4;
  SolverOptions integrate;  // default: RK4 1 ms, Newton closure, contact events located
};

/// The Jacobian of all car channels at `base` with respect to the axes' parameters. A curve of
/// nothing but rounding (its half-step error exceeds half of its size) is set to zero. Throws
/// InputError where a run cannot be made, fails, or never meets the snapshot's line.
Sensitivity calc_sensitivity(const Case& base, const std::vector<Axis>& axes, double offset,
                             const SensitivityOptions& options);

}  // namespace strut
