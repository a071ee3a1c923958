// The road's roughness as an unknown of each run of a car: heights of two tracks, which the rear
// wheels follow as the front ones did.
//
//   y = f(theta, u) + e,  u = sqrt(G0) P w,  w ~ N(0, 1)
//
// u: coefficients of both tracks (model/scenario/rough_track.h). P: the increments of their sum and
// their difference along the road are stationary, with the density
//
//   2 pi^2 n0^2 G0 (1 +- gamma(n)) (F(n) / B(n))^2,  n0 = 0.1 1/m
//
// of ISO 8608 and the coherence gamma of an isotropic road (noise_spectrum.h). F = sinc^4(n a), a a
// quarter of the tires' footprint, is the ratio of a wave's amplitude under the tires to that of
// the road; B = sinc^4(n h), h the spacing, that of the spline to that of its coefficients; sinc(x)
// = sin(pi x) / (pi x). The estimate of the road is in the simulation, and readings are linear
// about it: what roughness moves while a wheel is in the air or on the bump is not what it moves on
// level ground.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "base/math/eigen_abi.h"
#include "diagnose/campaign/campaign_data.h"
#include "diagnose/noise/landings.h"

namespace strut {

/// P: lower factors of the covariances of the half sum and the half difference of the tracks'
/// coefficients at G0 = 1 m^3; left is their sum, right their difference.
struct RoadPrior {
  Eigen::MatrixXd sum, difference;

  /// Coefficients, left before right, of weights of the sum before those of the difference.
  Eigen::VectorXd apply(const Eigen::VectorXd& weights) const;
  /// Derivatives by the weights of what has these derivatives by the coefficients.
  Eigen::MatrixXd apply_transposed(const Eigen::MatrixXd& derivatives) const;
};

/// The readings of a run as a linear function of the weights of its road.
struct WhitenedRoad {
  /// Derivative H by w of the readings, whitened by the sensors' noise; rows as in Whitener.
  Eigen::MatrixXd derivative;
  /// Lower L with L L' = 1 + H' H, and L + 1. (1 + L')^-1 L^-1 = X makes 1 - H X H' a root of the
  /// inverse of the readings' covariance 1 + H H'.
  Eigen::MatrixXd factor, raised;
};

struct LatentRoad {
  std::array<RoughTrack, 2> tracks;  // the estimate
  Eigen::VectorXd weights;           // w of the estimate
  double lead_speed = 0.0;  // m/s, by how much the car is faster at the begin of its lead time
  std::vector<LandingReading> landings{};  // on the estimate; excluded
  std::shared_ptr<const RoadPrior> prior{};
  /// Tens of megabytes, shared with the road at other weights; null: not known yet.
  std::shared_ptr<const WhitenedRoad> whitened{};
};
using LatentRoads = std::vector<std::shared_ptr<const LatentRoad>>;  // by run of a fit

struct TrackShape {
  Eigen::Index count = 0;  // coefficients of each track
  double spacing = 0.0;    // m, between them
  double width = 0.0;      // m, between the tracks
  double footprint = 0.0;  // m, over which the tires average the road; 0: they do not
};

RoadPrior make_road_prior(const TrackShape& shape);

/// Smooth roads under `runs`. These start kRoadLead earlier, since the car still moves by what it
/// met before the record.
LatentRoads make_smooth_roads(const CampaignData& data, const std::vector<std::size_t>& runs);
inline constexpr double kRoadLead = 1.0;  // s

/// The run on its road, with a clock that begins kRoadLead later.
MeasuredRun lay_road(const LatentRoad& road, MeasuredRun run);

/// The readings of `runs` against their simulation on these roads, one per run, with clocks that
/// begin kRoadLead later; without roads, against that of the campaign.
std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 const LatentRoads& roads,
                                                 std::vector<Unknown> unknowns, int threads = 1);

/// The road with the response of this derivative.
std::shared_ptr<const LatentRoad> set_response(const LatentRoad& road, Eigen::MatrixXd derivative);

/// The road at other weights, its response as it was. `level`: G0 [m^3].
std::shared_ptr<const LatentRoad> move_road(const LatentRoad& road, Eigen::VectorXd weights,
                                            double level);

/// The road with the landings of the car of run number `number` of a fit that drives over it;
/// `run`: its number in `data`.
std::shared_ptr<const LatentRoad> note_landings(const CampaignData& data, std::size_t run,
                                                const LatentRoad& road,
                                                const std::vector<Unknown>& unknowns,
                                                const std::vector<double>& values,
                                                std::size_t number);

/// The most likely weights of the linear model. `residual`: whitened by the sensors' noise, of the
/// model with the road.
Eigen::VectorXd solve_weights(const LatentRoad& road, const Eigen::VectorXd& residual);

/// Returns the effective number of weights that the readings determine: trace of
/// H'H (1 + H'H)^-1.
double count_determined(const LatentRoad& road);

/// The share of each whitened reading's noise that the road takes up: diagonal of
/// H (1 + H'H)^-1 H'.
Eigen::VectorXd calc_leverage(const LatentRoad& road);

}  // namespace strut
