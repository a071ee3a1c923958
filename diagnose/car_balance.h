// What a car's struts are like whatever the road and the tires do (R2 of a car): heave, pitch and
// roll of the body against the four struts at their measured deflections.
//
// At every frequency the channels y of a run obey
//
//   y = y_model(k, c) + sum_w h_w F_w + noise
//
// h_w: response of the channels to a vertical force at the contact patch of wheel w (the response
// to the road under it, noise_spectrum.h, which differs by a factor alone). Road, bump, tires and
// unsprung masses act on the channels through the F_w only. With F_w unknown at every instant, of n
// channels n - 4 combinations are left: those in which the body's accelerations balance the struts'
// forces and the deflections fit the body's motion. The F_w are taken as noise of a density far
// above what a wrong bump or tire makes of them, all of it is weighed by Whittle's likelihood
// (whitener.h), so that both sides of the balance go through the same filter, and the noise of
// deflections, which a regression on them would take for motion, biases nothing.
//
// Neglected: what wrong vertical forces bring along lengthwise and sideways, by the slope of the
// road and the tracks of the wheels; docs/diagnosis.md, "Without the road", has its size.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline.h"

namespace strut {

struct BalanceParameter {
  std::string name, unit;  // front_stiffness, ...
  double value = 0.0;
  double sigma = 0.0;  // 1 sigma, infinite where the run does not tell; of what is left, if more
                       // than noise
};

struct CarBalance {
  std::vector<BalanceParameter> parameters;  // stiffness and damping of the front, the rear axle
  /// Mean square of what is left over that of noise and of an unknown road: 1 where the struts'
  /// law is the model's, whatever tires and road are like.
  double chi2_per_reading = 1.0;
};

/// Of one run of a car, about the simulation `at`, which was made with `shared`. Of the shared
/// values those with a prior, a weighed mass, are fitted along; the others stay. Nothing for a rig,
/// and where the vertical acceleration of the body or the deflection of an axle is not measured.
/// Throws InputError where the car cannot be simulated.
std::optional<CarBalance> calc_car_balance(const CampaignData& data, std::size_t run,
                                           const SharedValues& shared, const RunEvaluation& at,
                                           int threads = 1);

}  // namespace strut
