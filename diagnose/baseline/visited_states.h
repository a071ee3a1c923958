// How the struts of a model move in some runs: what a force in them may depend on.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"

namespace strut {

/// The states of one place at which a force of a strut may act, all runs one after the other;
/// deflection counts from nominal trim or rest, both are positive in compression. Of a car the
/// spring's, of both corners of an axle.
struct VisitedStates {
  std::string place;                         // "front", "rear"; "" of a rig
  std::vector<double> deflection, velocity;  // m, m/s
  double force = 0.0;                        // N, spread of the damper's

  /// "rear suspension", "strut"
  std::string describe() const;
};

/// Of `runs` simulated at `shared`; those that cannot be simulated are left out. No more than some
/// thousand samples a place, evenly spread over the runs.
std::vector<VisitedStates> list_visited_states(const CampaignData& data,
                                               const std::vector<std::size_t>& runs,
                                               const SharedValues& shared);

}  // namespace strut
