// What the members of a group say of the model's own parameters. "Damping" means the slope at rest
// in one law and the slope far out in another, so the parameter differs between members that fit
// the readings equally; the secant of the strut's whole force over its motion is what they share.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/verdict.h"

namespace strut {

/// A value over the members: the extended model's, and the 95 % interval of all of them together.
struct GroupValue {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Slopes of a strut's force by least squares over its motion in the runs for fitting, with the
/// force of all its effects: F ~ F0 + stiffness d + damping v.
struct StrutSecant {
  std::string place;              // as StrutInfo::place
  GroupValue stiffness, damping;  // stiffness: NaN of a strut without a spring
};

/// Slopes of force over deflection and velocity, with a constant; zero without motion.
struct Slopes {
  double stiffness = 0.0, damping = 0.0;
};
Slopes fit_slopes(const std::vector<double>& deflection, const std::vector<double>& velocity,
                  const std::vector<double>& force);

/// The values of the first base.shared_count unknowns of the extended model over all close
/// candidates. A member's value is the extended model's plus its difference from the chosen
/// candidate in the same round.
std::vector<GroupValue> list_group_values(const Selection& selection,
                                          const std::vector<CausePosition>& positions);

/// The secants of every strut over all close candidates; each with the standard error that the
/// calibrated model, whose own parameters are secants, has for them.
std::vector<StrutSecant> list_secants(const CampaignData& data, const Selection& selection,
                                      const std::vector<CausePosition>& positions);

}  // namespace strut
