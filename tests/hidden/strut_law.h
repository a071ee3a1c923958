// The generator's own strut: spring, damper, and their faults.
//
// Every law differs in form from that of the tested program: exact dead bands, tables, slopes that
// jump.
// An effect is off at the magnitude 0 and, for small magnitudes, in proportion to it.
#pragma once

#include <array>

namespace strut::hidden {

/// Faults of a strut; all zero: a linear spring and damper.
struct StrutFaults {
  double asymmetry = 0.0;  // 1, damping (1 - a) in compression, (1 + a) in rebound
  double knee_loss = 0.0;  // 1, fraction of the damping lost above the knee
  double leak = 0.0;       // m, stroke after each reversal on which the damper is idle
  double friction = 0.0;   // N, breakaway of LuGre friction
  double hardening = 0.0;  // 1, k L (sinh(d / L) - d / L) on top of the spring
  double stop = 0.0;       // 1, multiple of the stop's table
  double mount = 0.0;      // 1, compliance of the mount over the scale's
  double gas_lag = 0.0;    // s, first-order lag of the damper's force
  double play = 0.0;       // m, gap of the joint in series with the damper, from stop to stop
  // Unknown to every catalogue:
  double selective = 0.0;      // 1, fraction of the damping that acts only at low frequency
  double side_friction = 0.0;  // N, friction that grows with the stroke it stands at
  double inerter = 0.0;        // kg, force in proportion to the acceleration of compression
  double gas = 0.0;            // 1, gas behind the damper's piston at rest over the scale's force
};

/// Typical lengths, speeds and forces of the strut, by which shapes are scaled.
struct StrutScale {
  double travel = 0.06;          // m
  double speed = 0.6;            // m/s
  double force = 2000.0;         // N
  double mount_rate = 300e3;     // N/m, at which the mount's fault is 1
  double breakaway = 3e-4;       // m, presliding of the friction
  double selective_rate = 30.0;  // rad/s
  double knee = 0.15;            // m/s
  double stop_gap = 0.025;       // m, of compression from rest
};

struct StrutLaw {
  double stiffness = 0.0;  // N/m
  double damping = 0.0;    // N s/m
  StrutScale scale;
  StrutFaults faults;
};

/// Inner states: friction's bristle [m], mount [m], leak's idle stroke [m], lag [N], the selective
/// damper's slow speed [m/s].
inline constexpr int kStrutStates = 5;
using StrutStates = std::array<double, kStrutStates>;

/// Force of the damper at a speed of compression, rising without bound [N].
double calc_damper_force(const StrutLaw& law, double speed);

/// Force of the stop at a compression from rest and its rate: table with linear sections times
/// 1 + 0.25 v / (|v| + 0.1 speed) [N].
double calc_stop_force(const StrutLaw& law, double travel, double speed);

/// Gas compressed along a column of four travels, polytropic with exponent 1.35, beyond its force
/// at rest [N].
double calc_gas_force(const StrutLaw& law, double travel);

/// Force beyond the static one, positive where it pushes the ends apart, of a compression from rest
/// [m] and its rate [m/s]; fills the rates of the inner states. Without the inerter's, which
/// belongs to the masses.
double calc_strut_force(const StrutLaw& law, double travel, double speed, const double* states,
                        double* rates);

}  // namespace strut::hidden
