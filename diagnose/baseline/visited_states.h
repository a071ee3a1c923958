// Deflections and velocities of a model's struts in given runs.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"

namespace strut {

/// The states of the strut at one location, all runs in sequence. Deflection is measured from
/// nominal trim or rest; deflection and velocity are positive in compression. For a car: the
/// springs of both corners of an axle.
struct VisitedStates {
  std::string place;                         // "front", "rear"; "" for a rig
  std::vector<double> deflection, velocity;  // m, m/s
  double force = 0.0;                        // spread of the damper's force [N]

  /// "rear suspension", "strut"
  std::string describe() const;
};

/// Simulates `runs` at `shared` and leaves out those that cannot be simulated. At most about 6000
/// samples per location, evenly spread over the runs.
std::vector<VisitedStates> list_visited_states(const CampaignData& data,
                                               const std::vector<std::size_t>& runs,
                                               const SharedValues& shared);

}  // namespace strut
