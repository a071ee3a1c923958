// Figures of the shock-absorber test of inspection stands: a wheel on a plate that sweeps from 25
// Hz down to rest with a fixed stroke of about 6 mm.
//
//   EUSAMA value       100 min F / W, F: contact force, W: static load (EUSAMA TS-02-76)
//   phase angle        min of the phase by which the first harmonic of F leads that of the plate's
//                      position, between the resonances of body and wheel (A. Tsymberov, SAE
//                      960735, 1996; EGEA, SPECSUS2018)
//   Lehr's damping     D = c / (2 sqrt(k m)), body: k = k_s, m = m_s; wheel: k = k_s + k_t, m = m_u
//
// The first two need no model: in windows of whole cycles of the plate, the least-squares fit
//
//   F(t) = sum over n = 0..3 of p_n(t) cos n theta + q_n(t) sin n theta
//
// with theta the plate's phase and p, q polynomials of time, gives them with standard errors from
// the scatter of its residuals. The third is derived from the parameters of a fit of the
// simulation, and so are the resonances: the body on spring and tire in series, the wheel between
// spring and tire, both without damping.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimate/fit.h"

namespace strut {

/// A reading of plate and contact force over time, in SI units.
struct PlateRecord {
  std::string name;              // the file, for messages
  std::vector<double> times;     // s, ascending
  std::vector<double> position;  // m, plate, up positive
  std::vector<double> force;     // N, of the plate on the tire, upwards, static load included
};

/// A number with its standard error.
struct PlateFigure {
  double value = 0.0, sigma = 0.0;
  double frequency = 0.0;  // Hz, of the plate, where it was found
};

/// The response in one window of the sweep.
struct PlateResponse {
  double frequency = 0.0;  // Hz
  PlateFigure min_force;   // N, lowest contact force of a cycle
  PlateFigure phase;       // degrees within 0 and 360, force before position
  double noise = 0.0;      // N, standard deviation of the force's residuals
};

/// The resonances between which the phase angle is sought.
struct PhaseBand {
  double body = 0.0;                      // Hz
  double wheel = 0.0, wheel_sigma = 0.0;  // Hz
};

struct PlateFigures {
  double static_load = 0.0;    // N
  PlateFigure eusama;          // %
  PlateFigure phase_angle;     // degrees
  bool at_wheel_mode = false;  // the phase falls up to the wheel's resonance
};

/// The response around each passage of the plate through its middle, over falling or rising
/// frequency as measured. Throws InputError where the plate makes fewer than 8 cycles, or too few
/// readings fall on a cycle.
std::vector<PlateResponse> calc_plate_responses(const PlateRecord& record);

/// Standard deviation [N] of the force's residuals, median over the windows.
double calc_plate_noise(const std::vector<PlateResponse>& responses);

/// Mean contact force [N] over whole cycles, which equals the weight since the momentum stays
/// bounded, also where the tire lifts off. Throws InputError where it is not above 0.
double calc_static_load(const PlateRecord& record);

/// Derives the figures from the responses. A lowest force below zero counts as zero. At the wheel's
/// resonance the phase is interpolated, with the resonance's own standard error. Throws InputError
/// where the sweep leaves the band without a response; `name` is the record's.
PlateFigures calc_plate_figures(const std::vector<PlateResponse>& responses, double static_load,
                                const PhaseBand& band, const std::string& name);

/// Number of parameters that fit_plate fits; they precede the initial states in its result.
inline constexpr std::size_t kPlateParameters = 6;

/// Fits masses, rates and dampings of the quarter car in `rig` to the contact force, driven by the
/// plate; the static load carries no unknown offset. `noise` [N] weights the readings. Throws
/// InputError.
FitResult fit_plate(const PlateRecord& record, const RigSpec& rig, double static_load, double noise,
                    int threads);

/// Resonances at a result of fit_plate, by linear propagation of its widened covariance.
PhaseBand calc_phase_band(const FitResult& fit);

/// Lehr's damping of body and wheel, likewise; `frequency` is that of the undamped mode.
struct LehrDamping {
  PlateFigure body, wheel;
};
LehrDamping calc_lehr_damping(const FitResult& fit);

}  // namespace strut
