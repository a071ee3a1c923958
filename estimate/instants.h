// Chooses the instants and sensors whose readings identify the parameters best.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/fisher.h"
#include "estimate/sensitivity.h"
#include "estimate/sensor_noise.h"

namespace strut {

/// Fisher information of one reading of `channels` at `instant`, with noise independent between
/// channels [1/%^2].
Eigen::MatrixXd calc_information(const Sensitivity& s, const Instant& instant,
                                 const std::vector<int>& channels, const SensorNoise& noise);

/// Fisher information at every instant of `s`.
std::vector<Eigen::MatrixXd> calc_informations(const Sensitivity& s,
                                               const std::vector<int>& channels,
                                               const SensorNoise& noise);

Eigen::MatrixXd sum_informations(const std::vector<Eigen::MatrixXd>& informations);

struct InstantChoice {
  std::vector<std::size_t> instants;  // distinct, ascending
  Eigen::MatrixXd information;        // their sum
};

/// Chooses the `count` instants with the minimum mean square bound (A-optimal). One is searched
/// exhaustively; more are added greedily and exchanged one by one until no exchange improves, from
/// several starts (V. V. Fedorov, Theory of Optimal Experiments, 1972). A local optimum,
/// deterministic.
InstantChoice choose_instants(const std::vector<Eigen::MatrixXd>& informations, int count);

/// Returns the channel of `candidates`, but not of `channels`, whose reading at `instant` lowers
/// the mean square bound most; -1 where there is none.
int choose_sensor(const Sensitivity& s, const Instant& instant, const std::vector<int>& channels,
                  const std::vector<int>& candidates, const SensorNoise& noise);

}  // namespace strut
