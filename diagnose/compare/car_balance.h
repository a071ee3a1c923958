// Stiffness and damping of a car's struts independent of the road and the tires (R2 of a car):
// heave, pitch and roll of the body against the four struts at their measured deflections.
//
// At every frequency the channels y of a run obey, near the model,
//
//   y = y_model(k, c) + sum_w h_w F_w + noise
//
// h_w: response of the channels to a vertical force at the contact patch of wheel w (computed as
// that to the road under it, noise_spectrum.h, which differs only by a factor). Errors of the
// model's bump, road, tires and unsprung masses act on the channels only through the F_w. With F_w
// unknown at every instant, n - 4 combinations of n channels remain: those in which the body's
// accelerations balance the struts' forces at the measured deflections. The F_w are modeled as
// noise with a density far above the error of any bump or tire, and the readings are weighted by
// Whittle's likelihood (whitener.h): both sides of the balance pass through the same filter, and
// the noise of the deflections, which would bias a regression on them, causes no bias.
//
// An error in a vertical force comes with one in the longitudinal force, by the slope of the road,
// which the arms convert to heave. Bump and tire stiffness are also fitted, to account for its
// shape; the remainder is neglected (docs/diagnosis.md, "Without the road", has the size of both).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"

namespace strut {

struct BalanceParameter {
  std::string name, unit;  // front_stiffness, ...
  double value = 0.0;
  double sigma = 0.0;  // standard error, widened if the residual exceeds noise; infinite where the
                       // run does not identify the parameter
};

struct CarBalance {
  std::vector<BalanceParameter> parameters;  // stiffness and damping of the front and rear axle
  /// Mean square of the residual relative to that of noise and an unknown road together: at most 1
  /// where the struts obey the model's law, for any tires and road.
  double chi2_per_reading = 1.0;
};

/// Calculates the balance of one run of a car, linearized about the simulation `at`, which was made
/// with `shared`. Shared values with a prior, such as a weighed mass, are also fitted; the others
/// are fixed. Null for a rig, and where the vertical acceleration of the body or the deflection of
/// an axle is not measured. Throws InputError where the car cannot be simulated.
std::optional<CarBalance> calc_car_balance(const CampaignData& data, std::size_t run,
                                           const SharedValues& shared, const RunEvaluation& at,
                                           int threads = 1);

}  // namespace strut
