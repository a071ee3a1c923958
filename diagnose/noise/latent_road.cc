#include "diagnose/noise/latent_road.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/error/check.h"
#include "base/least_squares/cholesky.h"
#include "diagnose/noise/smooth_road.h"
#include "model/car/state.h"
#include "model/scenario/road_density.h"

namespace strut {
namespace {

using Index = Eigen::Index;

/// m, of the tracks before the rear wheels' first place and behind the front wheels' last.
constexpr double kMargin = 0.5;
/// Coefficients a second of driving: twice the highest frequency that the tracks hold.
constexpr double kPerSecond = 100.0;

/// Ratio by which averaging with a cubic B-spline, knots `width` [m] apart, reduces a wave.
double calc_spline_gain(double wave_number, double width) {
  const double x = std::numbers::pi * wave_number * width;
  return x < 1e-6 ? 1.0 : std::pow(std::sin(x) / x, 4);
}

/// Covariance of the increments over a spacing of the tracks' half sum (`sign` 1) or half
/// difference (-1), `lag` increments apart, at G0 = 1 m^3.
Eigen::VectorXd calc_increment_covariance(const TrackShape& shape, double sign) {
  const auto& [count, spacing, width, footprint] = shape;
  constexpr int kSteps = 4096;
  const double highest = 0.5 / spacing, step = highest / kSteps;
  std::vector<double> density(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    const double n = step * (k + 0.5);
    // Amplitude of the coefficients' increments for a wave of the road with amplitude 1.
    const double rise = 2.0 * std::sin(std::numbers::pi * n * spacing) *
                        calc_spline_gain(n, 0.25 * footprint) / calc_spline_gain(n, spacing);
    density[static_cast<std::size_t>(k)] =
        calc_height_density(n) * rise * rise * 0.5 * (1.0 + sign * calc_track_coherence(n, width));
  }
  // Sum of density cos(pi (k + 1/2) lag / kSteps): a cosine transform, by one of twice the length.
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> transform;
  density.resize(2 * kSteps, 0.0);
  fft.fwd(transform, density);
  Eigen::VectorXd covariance(count);
  for (Index lag = 0; lag < count; ++lag) {
    const std::complex<double> half_step =
        std::polar(1.0, -0.5 * std::numbers::pi * static_cast<double>(lag) / kSteps);
    covariance(lag) =
        2.0 * step * (half_step * transform[static_cast<std::size_t>(lag) % density.size()]).real();
  }
  return covariance;
}

/// Lower factor of the covariance of heights whose increments have this covariance.
Eigen::MatrixXd factor_heights(const Eigen::VectorXd& increments) {
  constexpr double kRounding = 1e-9;
  const Index count = increments.size();
  Eigen::MatrixXd covariance(count, count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) covariance(i, j) = increments(std::abs(i - j));
  }
  covariance.diagonal().array() *= 1.0 + kRounding;
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  STRUT_CHECK(llt.info() == Eigen::Success, "a road's covariance is positive definite");
  Eigen::MatrixXd heights = llt.matrixL();
  for (Index i = 1; i < count; ++i) heights.row(i) += heights.row(i - 1);
  return heights;
}

void set_tracks(LatentRoad& road, double level) {
  const Eigen::VectorXd coefficients = std::sqrt(level) * road.prior->apply(road.weights);
  const Index count = coefficients.size() / 2;
  for (std::size_t track = 0; track < 2; ++track) {
    const auto from = coefficients.begin() + static_cast<Index>(track) * count;
    road.tracks[track].coefficients.assign(from, from + count);
  }
}

/// By how much a car is faster before its lead time, by its torque and its resistance.
double calc_lead_speed(Case c) {
  c.vehicle.effects.clear();
  c.vehicle.force_maps.clear();
  c.maneuver.road = RoadSpec{};
  c.maneuver.road.shape = BumpShape::kNone;
  c.maneuver.duration = kRoadLead;
  SamplePlan plan;
  plan.snapshot = false;
  const LaneRun run = simulate_smooth_road(c, plan);
  return c.maneuver.speed - run.results->get_final_state(StateIndex::kVelocity, run.lane);
}

std::shared_ptr<const LatentRoad> make_smooth_road(const MeasuredRun& run) {
  const Case& c = run.setup.car();
  const ManeuverSpec& m = c.maneuver;
  const auto& [front, rear] = c.vehicle.suspension;
  const double start = -m.bump_distance - kRoadLead * m.speed;  // of the front wheels
  const double way = m.speed * std::min(m.duration, run.times.back() + 0.1);
  LatentRoad road;
  road.lead_speed = calc_lead_speed(c);
  const double spacing = m.speed / kPerSecond;
  const double begin = start - c.vehicle.whole.wheelbase() - kMargin;
  const double end = start + kRoadLead * m.speed + way + kMargin;
  const auto count = static_cast<Index>(std::ceil((end - begin) / spacing));
  road.tracks.fill({begin, spacing, std::vector<double>(static_cast<std::size_t>(count), 0.0)});
  road.weights = Eigen::VectorXd::Zero(2 * count);
  const TireContactSpec& tire = c.vehicle.tire;
  const double footprint = tire.contact == ContactKind::kEnvelope ? tire.footprint : 0.0;
  road.prior = std::make_shared<const RoadPrior>(
      make_road_prior({count, spacing, front.wheel_center_y + rear.wheel_center_y, footprint}));
  return std::make_shared<const LatentRoad>(std::move(road));
}

}  // namespace

Eigen::VectorXd RoadPrior::apply(const Eigen::VectorXd& weights) const {
  const Index count = sum.rows();
  const Eigen::VectorXd common = sum.triangularView<Eigen::Lower>() * weights.head(count);
  const Eigen::VectorXd across = difference.triangularView<Eigen::Lower>() * weights.tail(count);
  Eigen::VectorXd coefficients(2 * count);
  coefficients << common + across, common - across;
  return coefficients;
}

Eigen::MatrixXd RoadPrior::apply_transposed(const Eigen::MatrixXd& derivatives) const {
  const Index count = sum.rows();
  Eigen::MatrixXd out(derivatives.rows(), 2 * count);
  const auto multiply = [&](const Eigen::MatrixXd& of_tracks, const Eigen::MatrixXd& lower,
                            Index at) {
    get_cholesky_kernel().multiply_lower(
        of_tracks.data(), lower.data(), static_cast<std::size_t>(of_tracks.rows()),
        static_cast<std::size_t>(count), out.data() + at * out.rows());
  };
  multiply(derivatives.leftCols(count) + derivatives.rightCols(count), sum, 0);
  multiply(derivatives.leftCols(count) - derivatives.rightCols(count), difference, count);
  return out;
}

RoadPrior make_road_prior(const TrackShape& shape) {
  return {factor_heights(calc_increment_covariance(shape, 1.0)),
          factor_heights(calc_increment_covariance(shape, -1.0))};
}

LatentRoads make_smooth_roads(const CampaignData& data, const std::vector<std::size_t>& runs) {
  LatentRoads roads;
  roads.reserve(runs.size());
  for (const std::size_t run : runs) roads.push_back(make_smooth_road(data.runs[run]));
  return roads;
}

MeasuredRun lay_road(const LatentRoad& road, MeasuredRun run) {
  ManeuverSpec& maneuver = run.setup.car().maneuver;
  maneuver.lead_time = kRoadLead;
  maneuver.lead_speed = road.lead_speed;
  maneuver.duration += kRoadLead;
  maneuver.rough = road.tracks;
  for (double& t : run.times) t += kRoadLead;
  return run;
}

std::unique_ptr<ReadingModel> make_reading_model(const CampaignData& data,
                                                 const std::vector<std::size_t>& runs,
                                                 const LatentRoads& roads,
                                                 std::vector<Unknown> unknowns, int threads) {
  if (roads.empty()) return make_reading_model(data, runs, std::move(unknowns), threads);
  // The step is about as wide as the unknowns are uncertain. Over a shorter one, a single reading
  // beside a contact event would seem to decide them; over this one its difference jumps and is
  // ignored (calc_jump_free_difference).
  constexpr double kRelativeStep = 1e-4;
  std::vector<MeasuredRun> laid;
  laid.reserve(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    laid.push_back(lay_road(*roads[i], data.runs[runs[i]]));
  }
  return make_reading_model(std::move(laid), std::move(unknowns), threads, kRelativeStep);
}

std::shared_ptr<const LatentRoad> set_response(const LatentRoad& road, Eigen::MatrixXd derivative) {
  const CholeskyKernel& kernel = get_cholesky_kernel();
  const auto count = static_cast<std::size_t>(derivative.cols());
  auto response = std::make_shared<WhitenedRoad>();
  Eigen::MatrixXd& factor = response->factor;
  factor = Eigen::MatrixXd::Identity(derivative.cols(), derivative.cols());
  kernel.add_normal(derivative.data(), static_cast<std::size_t>(derivative.rows()), count,
                    factor.data());
  const bool is_finite = kernel.factor_diagonal(factor.data(), count, count);
  STRUT_CHECK(is_finite, "a road's response is finite");
  response->raised = factor;
  response->raised.diagonal().array() += 1.0;
  response->derivative = std::move(derivative);
  auto out = std::make_shared<LatentRoad>(road);
  out->whitened = std::move(response);
  return out;
}

std::shared_ptr<const LatentRoad> move_road(const LatentRoad& road, Eigen::VectorXd weights,
                                            double level) {
  auto out = std::make_shared<LatentRoad>(road);
  out->weights = std::move(weights);
  set_tracks(*out, level);
  return out;
}

std::shared_ptr<const LatentRoad> note_landings(const CampaignData& data, std::size_t run,
                                                const LatentRoad& road,
                                                const std::vector<Unknown>& unknowns,
                                                const std::vector<double>& values,
                                                std::size_t number) {
  auto out = std::make_shared<LatentRoad>(road);
  out->landings = list_landings(lay_road(road, data.runs[run]), unknowns, values, number);
  return out;
}

Eigen::VectorXd solve_weights(const LatentRoad& road, const Eigen::VectorXd& residual) {
  const auto& [derivative, factor, raised] = *road.whitened;
  Eigen::VectorXd weights = derivative.transpose() * (derivative * road.weights - residual);
  factor.triangularView<Eigen::Lower>().solveInPlace(weights);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(weights);
  return weights;
}

double count_determined(const LatentRoad& road) {
  const auto n = static_cast<std::size_t>(road.weights.size());
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(road.weights.size(), road.weights.size());
  get_cholesky_kernel().solve_panel(road.whitened->factor.data(), n, inverse.data(), n, n);
  return static_cast<double>(n) - inverse.squaredNorm();
}

Eigen::VectorXd calc_leverage(const LatentRoad& road) {
  const auto& [derivative, factor, raised] = *road.whitened;
  const Index rows = derivative.rows(), n = factor.cols();
  // H L^-T, by the kernel, for which both have as many rows.
  const Index lead = std::max(rows, n);
  Eigen::MatrixXd lower(lead, n), along(lead, n);
  lower.topRows(n) = factor;
  along.topRows(rows) = derivative;
  get_cholesky_kernel().solve_panel(lower.data(), static_cast<std::size_t>(n), along.data(),
                                    static_cast<std::size_t>(rows), static_cast<std::size_t>(lead));
  return along.topRows(rows).rowwise().squaredNorm();
}

}  // namespace strut
