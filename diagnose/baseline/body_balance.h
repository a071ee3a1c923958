// Residuals that need no road: what two masses on a strut must satisfy whatever the plate or
// the tire does (diagnosis.md 3.2, R1 and R2).
//
//   R1  d2(z_s)/dt2 - a_s,  d2(z_u)/dt2 - a_u       where positions and accelerations are measured
//   R2  m_s a_s - F_s(delta, v) - F_a               F_s: strut at the measured deflection
//
// A wrong tire, road or unsprung mass leaves both at zero; a wrong strut shows in R2 alone, a wrong
// sensor in both. Second derivatives are those of local cubics (local_cubic.h), an operator D. What
// they are compared with goes through the same filter, D[y twice integrated], so that smoothing
// adds no bias:
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
  std::vector<double> force;          // N, m_s a_s - F_a, filtered: what the strut must have done
  std::vector<double> residual;       // N, force less the model's strut
  double rms = 0.0, nrmse = 0.0;      // N, and of the force's spread
  double noise_rms = 0.0;             // N, that the sensors' noise alone leaves
  std::vector<StateResidual> states;  // over deflection and velocity
  /// Linear strut by the balance alone, at the model's sprung mass, without road and tire.
  double stiffness = 0.0, stiffness_sigma = 0.0, damping = 0.0, damping_sigma = 0.0;
  std::vector<KinematicResidual> kinematics;
};

/// At a run's setup (set_unknowns). Nothing where the model has not two masses, or their positions
/// are not both measured.
std::optional<BodyBalance> calc_body_balance(const MeasuredRun& run);

}  // namespace strut
