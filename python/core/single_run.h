// One run of a car, with derivatives where they are asked for.
#pragma once

#include <string>
#include <vector>

#include "model/kernel/simulation.h"

namespace strut {

struct SingleRequest {
  Case setup;
  SolverOptions integrate;
  double interval = 0.0;                 // s, of the history
  std::vector<int> channels;             // of the history; the snapshot has all
  std::vector<std::string> derivatives;  // parameters
};

/// Runs the case as `strut simulate` does. With derivatives the run is that of a lane, and
/// LaneResults::slopes has one element for each parameter. Throws InputError for a parameter by
/// which the case is not differentiable, ModelError where the case cannot be prepared.
LaneResults simulate_single(const SingleRequest& request);

}  // namespace strut
