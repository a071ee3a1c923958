// The road as an unknown against dense linear algebra, and against roads drawn at a known level.
#include "diagnose/noise/latent_road.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnose/noise/measure_color.h"
#include "diagnose/noise/whitener.h"
#include "model/scenario/rough_track.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

constexpr std::size_t kSamples = 60, kChannels = 2;
constexpr Eigen::Index kWeights = 8;

/// Readings of two channels, none of which the unknown moves.
class IdleModel : public ReadingModel {
 public:
  explicit IdleModel(std::size_t runs, std::size_t samples = kSamples) : ReadingModel({Unknown{}}) {
    unknowns_.front().name = "idle";
    for (std::size_t r = 0; r < runs; ++r) {
      channels_.push_back({0, 1});
      for (std::size_t t = 0; t < samples; ++t) {
        for (std::size_t c = 0; c < kChannels; ++c) readings_.push_back({r, t, c});
      }
    }
  }
  Linearization linearize(const std::vector<double>& /*values*/) override { return {}; }
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& /*points*/) override {
    return {};
  }
};

NoiseSpectrum make_white() {
  NoiseSpectrum s;
  s.samples = kSamples;
  s.interval = 0.02;  // the highest frequency is 25 Hz
  s.sigma = {1.0, 1.0};
  return s;
}

Eigen::MatrixXd draw(std::uint64_t seed, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd out(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      out(i, j) = test::calc_test_normal(seed, static_cast<std::uint64_t>(i),
                                         static_cast<std::uint64_t>(j));
    }
  }
  return out;
}

constexpr Eigen::Index kReadings = static_cast<Eigen::Index>(kSamples * kChannels);

std::shared_ptr<const LatentRoad> make_road(std::uint64_t seed) {
  LatentRoad road;
  road.weights = draw(seed + 1, kWeights, 1);
  return set_response(road, 0.7 * draw(seed, kReadings, kWeights));
}

/// All of a road's part that whitening takes out, as a matrix.
struct WhitenedRun {
  IdleModel model{1};
  std::shared_ptr<const LatentRoad> road = make_road(5);
  Whitener plain{model, {make_white()}}, whitener{model, {make_white()}, {road}};
  /// From readings to sensors' numbers: orthogonal.
  Eigen::MatrixXd rotation = plain.apply(Eigen::MatrixXd::Identity(kReadings, kReadings));
  Eigen::MatrixXd response = road->whitened->derivative;
};

TEST_CASE("Readings over an unknown road are whitened by a root of their inverse covariance",
          "[unit]") {
  const WhitenedRun run;
  REQUIRE((run.rotation * run.rotation.transpose()).isIdentity(tolerance(1e-12)));
  const Eigen::MatrixXd root = run.whitener.apply(run.rotation.transpose());
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(kReadings, kReadings) + run.response * run.response.transpose();
  CHECK((root * covariance * root.transpose()).isIdentity(tolerance(1e-10)));
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const double half = llt.matrixLLT().diagonal().array().log().sum();
  CHECK(run.whitener.get_log_determinant(0) - run.plain.get_log_determinant(0) ==
        Approx(half).epsilon(tolerance(1e-10)));
}

TEST_CASE("Residuals of a model with a road are whitened about the road's prior mean", "[unit]") {
  const WhitenedRun run;
  const Eigen::VectorXd readings = draw(9, kReadings, 1);
  const Eigen::VectorXd sensors = run.rotation * readings;
  const Eigen::VectorXd whitened = run.whitener.apply_residual(readings);
  const Eigen::VectorXd about = sensors - run.response * run.road->weights;
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(kReadings, kReadings) + run.response * run.response.transpose();
  CHECK(whitened.squaredNorm() ==
        Approx(about.dot(covariance.llt().solve(about))).epsilon(tolerance(1e-10)));
  CHECK((run.whitener.apply_sensors(0, readings) - sensors).norm() < tolerance(1e-12));
}

TEST_CASE("The weights of a road are those of ridge regression", "[unit]") {
  const WhitenedRun run;
  const Eigen::VectorXd here = draw(9, kReadings, 1);
  const Eigen::VectorXd weights = solve_weights(*run.road, here);
  // The gradient of |here + H (w - w0)|^2 + |w|^2.
  const Eigen::VectorXd gradient =
      run.response.transpose() * (here + run.response * (weights - run.road->weights)) + weights;
  CHECK(gradient.norm() < tolerance(1e-10));
  const Eigen::MatrixXd gram = run.response.transpose() * run.response;
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(kWeights, kWeights) + gram;
  CHECK(count_determined(*run.road) ==
        Approx((gram * all.inverse()).trace()).epsilon(tolerance(1e-10)));
  const Eigen::VectorXd share =
      (run.response * all.inverse() * run.response.transpose()).diagonal();
  CHECK((calc_leverage(*run.road) - share).norm() < tolerance(1e-12));
}

/// A road under which wheels land at three readings, two of them successive.
LatentRoad make_road_of_landings() {
  LatentRoad road;
  road.weights = Eigen::VectorXd::Zero(kWeights);
  road.landings = {{0, 7}, {1, 30}, {1, 31}};
  return road;
}

TEST_CASE("Readings of a landing wheel are excluded and others are not", "[unit]") {
  IdleModel model(1);
  const auto road = std::make_shared<const LatentRoad>(make_road_of_landings());
  const Whitener whitener(model, {make_white()}, {road});
  const Eigen::MatrixXd units = Eigen::MatrixXd::Identity(kReadings, kReadings);
  const Eigen::MatrixXd gram =
      whitener.whiten_run(0, units).transpose() * whitener.whiten_run(0, units);
  Eigen::VectorXd counts = Eigen::VectorXd::Ones(kReadings);
  for (const auto& [channel, time] : road->landings) {
    counts(static_cast<Eigen::Index>(time * kChannels + channel)) = 0.0;
  }
  // All frequencies count here, so that whitening keeps sums of squares.
  CHECK((gram - Eigen::MatrixXd(counts.asDiagonal())).norm() < tolerance(1e-12));
  CHECK(whitener.get_share(0) ==
        Approx(counts.sum() / static_cast<double>(kReadings)).epsilon(tolerance(1e-12)));
  const WhitenedModel whitened(model, whitener);
  CHECK(whitened.calc_independent_count() == Approx(counts.sum()).epsilon(tolerance(1e-12)));
}

/// 3 s at 500 Hz, of which a road keeps 33 Hz, with seven successive readings of a landing.
struct LongRun {
  static constexpr std::size_t kCount = 1500, kFirst = 700;
  IdleModel model{1, kCount};
  LatentRoads roads;

  LongRun() {
    LatentRoad road;
    road.weights = Eigen::VectorXd::Zero(kWeights);
    for (std::size_t t = kFirst; t < kFirst + 7; ++t) road.landings.push_back({1, t});
    roads.push_back(std::make_shared<const LatentRoad>(std::move(road)));
  }
  static NoiseSpectrum make_spectrum() {
    NoiseSpectrum s = make_white();
    s.samples = kCount;
    s.interval = 2e-3;
    return s;
  }
};

TEST_CASE("Hardly anything of a landing passes where frequencies distinguish few readings",
          "[unit]") {
  const LongRun run;
  const Whitener whitener(run.model, {LongRun::make_spectrum()}, run.roads);
  const auto whiten = [&](std::size_t time, double size) {
    Eigen::VectorXd reading = Eigen::VectorXd::Zero(LongRun::kCount * kChannels);
    reading(static_cast<Eigen::Index>(time * kChannels + 1)) = size;
    return whitener.whiten_run(0, reading).norm();
  };
  for (std::size_t t = LongRun::kFirst; t < LongRun::kFirst + 7; ++t) {
    CHECK(whiten(t, 300.0) < 2.0);
  }
  // Elsewhere a reading has its part of the frequencies, 2 * 33 of 500 Hz.
  CHECK(whiten(300, 300.0) == Approx(300.0 * std::sqrt(66.0 / 500.0)).epsilon(0.01));
  // The band holds 2 to 5 independent combinations of the seven readings.
  const double excluded =
      (1.0 - whitener.get_share(0)) * static_cast<double>(whitener.whitened_count());
  CHECK(excluded > 1.5);
  CHECK(excluded < 5.5);
}

TEST_CASE("Numbers are whitened again by the drift of other sensors", "[unit]") {
  const IdleModel model(1);
  const auto road = std::make_shared<const LatentRoad>(make_road_of_landings());
  NoiseSpectrum drifting = make_white();
  drifting.color = {{0, 3.0, {}}, {1, 0.4, {}}};
  const Whitener before(model, {make_white()}, {road}), after(model, {drifting}, {road});
  const Eigen::MatrixXd columns = draw(17, kReadings, 5);
  const Eigen::MatrixXd again = after.rewhiten_run(0, before.whiten_run(0, columns), before);
  CHECK((again - after.whiten_run(0, columns)).norm() < tolerance(1e-12));
  CHECK((again - before.whiten_run(0, columns)).norm() > 1.0);

  const LongRun run;
  drifting.samples = LongRun::kCount;
  drifting.interval = 2e-3;
  const Whitener long_before(run.model, {LongRun::make_spectrum()}, run.roads);
  const Whitener long_after(run.model, {drifting}, run.roads);
  const Eigen::MatrixXd readings = draw(18, LongRun::kCount * kChannels, 3);
  const Eigen::MatrixXd direct = long_after.whiten_run(0, readings);
  const Eigen::MatrixXd indirect =
      long_after.rewhiten_run(0, long_before.whiten_run(0, readings), long_before);
  CHECK((indirect - direct).norm() < tolerance(1e-10));
}

/// Sum of squares of the whitened readings of a tone of 10 standard deviations at 61.3 Hz.
double calc_leaked_power(bool is_cut_off) {
  constexpr std::size_t kLong = 1500;
  const IdleModel model(1, kLong);
  NoiseSpectrum s = make_white();
  s.samples = kLong;
  s.interval = 2e-3;
  s.fades = is_cut_off;
  LatentRoad road;
  road.weights = Eigen::VectorXd::Zero(kWeights);
  const Whitener whitener(model, {s}, {std::make_shared<const LatentRoad>(road)});
  Eigen::VectorXd tone(static_cast<Eigen::Index>(kLong * kChannels));
  for (Eigen::Index i = 0; i < tone.size(); ++i) {
    tone(i) = 10.0 * std::sin(2.0 * std::numbers::pi * 61.3 * s.interval *
                              std::floor(static_cast<double>(i) / kChannels));
  }
  return whitener.apply_residual(tone).squaredNorm();
}

TEST_CASE("Hardly any waves too short for a road leak from the ends of a cut-off record",
          "[unit]") {
  CHECK(calc_leaked_power(false) > 5.0);
  CHECK(calc_leaked_power(true) < 0.5);
}

/// Corners [Hz] found in what roads leave of the noise of sensors with this corner, by channel.
std::vector<double> measure_corners(double corner) {
  constexpr std::size_t kRuns = 100;
  const IdleModel model(kRuns);
  const IdleModel alone(1);
  const Whitener plain(alone, {make_white()});
  const Eigen::MatrixXd rotation = plain.apply(Eigen::MatrixXd::Identity(kReadings, kReadings));
  LatentRoads roads;
  Eigen::VectorXd residual(static_cast<Eigen::Index>(kRuns) * kReadings);
  for (std::size_t r = 0; r < kRuns; ++r) {
    // A road that takes most of the low frequencies, where drift is.
    Eigen::MatrixXd response = 0.3 * draw(40 + r, kReadings, kWeights);
    response.topRows(kReadings / 4) *= 20.0;
    LatentRoad road;
    road.weights = Eigen::VectorXd::Zero(kWeights);
    const auto answering = set_response(road, response);
    Eigen::VectorXd noise = draw(260 + r, kReadings, 1);
    for (Eigen::Index i = 0; i < kReadings; ++i) {
      const double hertz = plain.get_frequency(plain.places()[static_cast<std::size_t>(i)]);
      if (hertz > 0.0) noise(i) *= std::sqrt(1.0 + corner / hertz);
    }
    const Eigen::VectorXd seen = noise + response * draw(460 + r, kWeights, 1);
    // Less the road found.
    const Eigen::VectorXd left = seen + response * solve_weights(*answering, seen);
    roads.push_back(answering);
    residual.segment(static_cast<Eigen::Index>(r) * kReadings, kReadings) =
        rotation.transpose() * left;
  }
  NoiseSpectrum white = make_white();
  white.color = {{0, 0.0, {}}, {1, 0.0, {}}};
  std::vector<NoiseSpectrum> spectra(kRuns, white);
  const Whitener sensors(model, spectra, roads);
  CHECK(measure_drift_beside_roads(model, sensors, residual, spectra) == (corner > 0.0));
  std::vector<double> corners;
  for (const SensorColor& c : spectra.back().color) corners.push_back(c.corner);
  return corners;
}

TEST_CASE("Drift is measured beside a road that takes up part of it", "[statistical]") {
  for (const double found : measure_corners(0.0)) CHECK(found < 0.05);
  for (const double found : measure_corners(1.0)) CHECK(found == Approx(1.0).epsilon(0.3));
}

/// Amplitude of a wave of `wave_number` [1/m] after four averages over a quarter of the footprint
/// each, on a fine grid.
double average_wave(double wave_number, double footprint) {
  constexpr int kPoints = 400;
  if (footprint == 0.0) return 1.0;
  double once = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double x = 0.25 * footprint * ((i + 0.5) / kPoints - 0.5);
    once += std::cos(2.0 * std::numbers::pi * wave_number * x) / kPoints;
  }
  return std::pow(once, 4);
}

/// Variance over 1 m^3 of the integral of a track's height times a wave under a Hann window.
/// `side`: 0 left, 1 right.
double calc_wave_variance(const RoadPrior& prior, double spacing, double wave_number,
                          Eigen::Index side) {
  const Eigen::Index count = prior.sum.rows();
  constexpr int kFiner = 8;  // points to a spacing
  const double length = spacing * static_cast<double>(count - 3), step = spacing / kFiner;
  Eigen::VectorXd by_coefficient = Eigen::VectorXd::Zero(2 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    RoughTrack track{0.0, spacing, std::vector<double>(static_cast<std::size_t>(count), 0.0)};
    track.coefficients[static_cast<std::size_t>(i)] = 1.0;
    const RoughTrack* const tracks[] = {&track};
    const RoughTracks<double> rough = make_rough_tracks<double>(tracks);
    for (double x = 3.0 * spacing; x < length; x += step) {
      double height = 0.0, slope = 0.0;
      add_roughness(rough, x, height, slope);
      const double place = (x - 3.0 * spacing) / (length - 3.0 * spacing);
      const double window = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * place));
      by_coefficient(side * count + i) +=
          step * window * std::cos(2.0 * std::numbers::pi * wave_number * x) * height;
    }
  }
  return prior.apply_transposed(by_coefficient.transpose()).squaredNorm();
}

TEST_CASE("A road's prior has the density of ISO 8608 under the tires in either track", "[unit]") {
  constexpr double kSpacing = 0.05, kWidth = 1.5;
  constexpr Eigen::Index kCount = 200;
  // Integral of the window's square. The density bends within the window's band: 1 % at 1 / m.
  const double window = kSpacing * static_cast<double>(kCount - 6) * 3.0 / 8.0;
  for (const double footprint : {0.0, 0.12}) {
    const RoadPrior prior = make_road_prior({kCount, kSpacing, kWidth, footprint});
    for (const double wave_number : {1.0, 3.0, 6.6, 8.0}) {
      const double felt = average_wave(wave_number, footprint);
      const double density = 0.5 * 0.01 / (wave_number * wave_number) * felt * felt;
      for (const Eigen::Index side : {0, 1}) {
        CHECK(calc_wave_variance(prior, kSpacing, wave_number, side) ==
              Approx(0.5 * density * window).epsilon(tolerance(0.03)));
      }
    }
  }
  const RoadPrior prior = make_road_prior({kCount, kSpacing, kWidth, 0.12});
  Eigen::MatrixXd factor(2 * kCount, 2 * kCount);
  for (Eigen::Index i = 0; i < 2 * kCount; ++i) {
    factor.col(i) = prior.apply(Eigen::VectorXd::Unit(2 * kCount, i));
  }
  // Long waves lift both tracks alike: 10 m are many times their distance.
  const Eigen::VectorXd left = (factor.row(199) - factor.row(0)).transpose();
  const Eigen::VectorXd right = (factor.row(399) - factor.row(200)).transpose();
  const double coherence = left.dot(right) / (left.norm() * right.norm());
  CHECK(coherence > 0.6);
  CHECK(coherence < 0.9);
  // The transposed derivative is that of the coefficients.
  const Eigen::MatrixXd derivatives = draw(3, 4, 2 * kCount);
  CHECK((prior.apply_transposed(derivatives) - derivatives * factor).norm() < tolerance(1e-10));
}

}  // namespace
}  // namespace strut
