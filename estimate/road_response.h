// Responses of a car to small changes of a rough road (model/scenario/rough_track.h): a linear
// system, the derivatives of whose short sections by state and road are simulated.
//
//   x_(s+1)' = A_s x_s' + B_s u',  y_s' = C_s x_s' + D_s u'
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/crossing_batch.h"

namespace strut {

/// Derivatives of what a run's compared channels read by the coefficients of its tracks.
struct RoadResponse {
  double interval = 0.0;          // s, between samples
  Eigen::Index samples = 0;       // of each channel
  Eigen::MatrixXd derivatives{};  // samples, channel by channel, x coefficients, left before right
  long simulation_count = 0;      // as many whole runs
};

/// Simulates `setup`, a run's car with its tracks and the effects of its sensors. Steps are
/// four times as long as a fit's: derivatives by a road need not be exact. `preparer`: of this
/// run. Returns why the run cannot be simulated, "" if it can.
std::string simulate_road_response(const MeasuredRun& run, const Case& setup,
                                   const LinearizeOptions& options, CasePreparer& preparer,
                                   RoadResponse& response);

}  // namespace strut
