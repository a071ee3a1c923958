// Stiffness and damping of a car's struts independent of the road and the tires (R2 of a car):
// heave, pitch and roll of the body against the four struts at their measured deflections.
//
// At every frequency the channels y of a run obey, near the model,
//
//   y = y_model(k, c) + sum_w h_w F_w + noise
//
// h_w: response of the channels to a vertical force at the contact patch of wheel w (that to the
// road under it, noise_spectrum.h, which differs by a factor alone). Bump, road, tires and unsprung
// masses that are not the model's act on the channels through the F_w. With F_w unknown at every
// instant, of n channels n - 4 combinations are left: those in which the body's accelerations
// balance the struts' forces at the deflections that there are. The F_w are taken as noise of a
// density far above what a wrong bump or tire makes of them, and all of it is weighed by Whittle's
// likelihood (whitener.h): both sides of the balance go through the same filter, and the noise of
// the deflections, which a regression on them would take for motion, biases nothing.
//
// A wrong vertical force also brings one lengthwise, by the slope of the road, which the arms turn
// into heave. Bump and tire stiffness are fitted along to have its shape; what is left of it is
// neglected (docs/diagnosis.md, "Without the road", has the size of both).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"

namespace strut {

struct BalanceParameter {
  std::string name, unit;  // front_stiffness, ...
  double value = 0.0;
  double sigma = 0.0;  // 1 sigma, infinite where the run does not tell; of what is left, if more
                       // than noise
};

struct CarBalance {
  std::vector<BalanceParameter> parameters;  // stiffness and damping of the front, the rear axle
  /// Mean square of what is left over that of noise and an unknown road together: at most 1 where
  /// the struts' law is the model's, whatever tires and road are like.
  double chi2_per_reading = 1.0;
};

/// The balance of one run of a car, about the simulation `at`, which was made with `shared`. Shared
/// values with a prior, such as a weighed mass, are fitted along; the others stay. Nothing for a
/// rig, and where the vertical acceleration of the body or the deflection of an axle is not
/// measured. Throws InputError where the car cannot be simulated.
std::optional<CarBalance> calc_car_balance(const CampaignData& data, std::size_t run,
                                           const SharedValues& shared, const RunEvaluation& at,
                                           int threads = 1);

}  // namespace strut
