// Residuals independent of the road: equations of two masses on a strut that hold for any motion of
// the plate and any tire (R1 and R2).
//
//   R1  d2(z_s)/dt2 - a_s,  d2(z_u)/dt2 - a_u       where positions and accelerations are measured
//   R2  m_s a_s - F_s(delta, v) - F_a               F_s: strut at the measured deflection
//
// A wrong tire, road or unsprung mass leaves both at zero; a wrong strut shows in R2 alone, a wrong
// sensor in both. D: second derivative by local cubics (local_polynomial.h). A quantity y that is
// compared with it passes through the same filter, as D[y twice integrated], so that smoothing adds
// no bias:
//
//   R2 = D[m_s z_s] - D[integral integral (F_s + F_a)]
#pragma once

#include <optional>
#include <vector>

#include "diagnose/baseline/residuals.h"
#include "estimate/measured_run.h"

namespace strut {

struct KinematicResidual {
  std::string channel;  // the acceleration
  double rms = 0.0;     // m/s^2
  double spread = 0.0;  // of the measured acceleration
  double gain = 1.0;    // least squares: measured = gain * differentiated
};

struct BodyBalance {
  double half_width = 0.0;                   // s, of the local cubics
  std::vector<double> deflection, velocity;  // m, m/s, filtered; compression positive, by time
  std::vector<double> force;          // N, m_s a_s - F_a, filtered: the strut's force by balance
  std::vector<double> residual;       // N, force less the model's strut
  double rms = 0.0, nrmse = 0.0;      // N, and as a fraction of the force's spread
  double noise_rms = 0.0;             // N, expected rms from the sensors' noise alone
  std::vector<StateResidual> states;  // over deflection and velocity
  /// Linear strut by the balance alone, at the model's sprung mass, independent of road and tire.
  double stiffness = 0.0, stiffness_sigma = 0.0, damping = 0.0, damping_sigma = 0.0;
  std::vector<KinematicResidual> kinematics;
};

/// Calculates the balance at a run's setup (set_unknowns). Null unless the model has two masses,
/// both positions are measured, and only the strut and a recorded actuator act on the sprung mass.
std::optional<BodyBalance> calc_body_balance(const MeasuredRun& run);

}  // namespace strut
