// Deflections and velocities of a model's struts in given runs, on which a force in them may
// depend.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"

namespace strut {

/// The states of one place at which a force of a strut may act, all runs one after the other.
/// Deflection counts from nominal trim or rest; both are positive in compression. For a car: the
/// springs of both corners of an axle.
struct VisitedStates {
  std::string place;                         // "front", "rear"; "" for a rig
  std::vector<double> deflection, velocity;  // m, m/s
  double force = 0.0;                        // spread of the damper's force [N]

  /// "rear suspension", "strut"
  std::string describe() const;
};

/// Simulates `runs` at `shared`, without those that cannot be simulated. At most about 6000 samples
/// a place, evenly spread over the runs.
std::vector<VisitedStates> list_visited_states(const CampaignData& data,
                                               const std::vector<std::size_t>& runs,
                                               const SharedValues& shared);

}  // namespace strut
