#include "diagnose/noise/whitener.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "base/error/check.h"
#include "base/parallel/team.h"

namespace strut {
namespace {

constexpr std::size_t kMissing = static_cast<std::size_t>(-1);

/// Over sigma^2; by the sensors alone or with what all channels have in common.
Eigen::MatrixXcd calc_covariance(const NoiseSpectrum& spectrum, Eigen::Index frequency,
                                 bool of_sensors) {
  const auto channels = static_cast<Eigen::Index>(spectrum.sigma.size());
  Eigen::MatrixXcd covariance = Eigen::MatrixXcd::Identity(channels, channels);
  const auto at = static_cast<std::size_t>(frequency);
  const double step = 1.0 / (static_cast<double>(spectrum.samples) * spectrum.interval);
  for (std::size_t c = 0; c < spectrum.color.size(); ++c) {
    const double hertz = step * static_cast<double>(std::max<std::size_t>(at, 1));
    covariance.diagonal()(static_cast<Eigen::Index>(c)) +=
        calc_color(spectrum.color[c], hertz, spectrum.samples, spectrum.interval);
  }
  if (of_sensors || at >= spectrum.common.size()) return covariance;
  const Eigen::VectorXd sigma = Eigen::Map<const Eigen::VectorXd>(spectrum.sigma.data(), channels);
  const Eigen::VectorXd scale = std::sqrt(spectrum.level) * sigma.cwiseInverse();
  const Eigen::MatrixXcd common = scale.asDiagonal() * spectrum.common[at] * scale.asDiagonal();
  covariance += common;
  const double response_error = spectrum.response_error;
  covariance.diagonal() += response_error * response_error * common.diagonal();
  return covariance;
}

/// The taper of a cut-off record. Beside a road of its own, only waves that are too short for its
/// tracks are left in it, which leak from the ends.
std::vector<double> make_run_fade(const NoiseSpectrum& spectrum, bool has_road) {
  constexpr double kRoadFade = 0.05;  // s
  std::size_t length = calc_fade_length(spectrum.samples);
  if (has_road) length = std::min(length, static_cast<std::size_t>(kRoadFade / spectrum.interval));
  return make_fade(spectrum.samples, spectrum.fades ? length : 0);
}

}  // namespace

Whitener::Whitener(const ReadingModel& model, std::vector<NoiseSpectrum> spectra, LatentRoads roads,
                   const WhitenerOptions& options)
    : spectra_(std::move(spectra)),
      roads_(std::move(roads)),
      reading_count_(model.reading_count()) {
  for (std::size_t r = 0; r < spectra_.size(); ++r) {
    const NoiseSpectrum& spectrum = spectra_[r];
    const std::size_t channels = spectrum.sigma.size();
    Run run;
    const bool is_red = spectrum.fades && !has_road(r);
    const double highest = has_road(r) ? options.highest_of_road : options.highest;
    run.fade = make_run_fade(spectrum, has_road(r));
    run.rows.assign(channels, std::vector<std::size_t>(spectrum.samples, kMissing));
    double power = 0.0;
    for (std::size_t k = 0; k < reading_count_; ++k) {
      const ReadingPlace& place = model.readings()[k];
      if (place.run != r) continue;
      if (run.count++ == 0) run.begin = k;
      if (place.time >= spectrum.samples) continue;
      run.rows[place.channel][place.time] = k - run.begin;
      power += run.fade[place.time] * run.fade[place.time];
    }
    run.share = power / static_cast<double>(channels * spectrum.samples);
    run_begin_.push_back(places_.size());
    const double step = 1.0 / (static_cast<double>(spectrum.samples) * spectrum.interval);
    if (is_red) run.first = static_cast<Eigen::Index>(std::ceil(options.lowest / step));
    for (auto k = static_cast<std::size_t>(run.first); k <= spectrum.samples / 2; ++k) {
      if (step * static_cast<double>(k) > highest) break;
      const double excess = spectrum.excess[find_noise_band(step * static_cast<double>(k))];
      const Eigen::LLT<Eigen::MatrixXcd> factor(
          excess * calc_covariance(spectrum, static_cast<Eigen::Index>(k), has_road(r)));
      run.factor.emplace_back(factor.matrixL());
      const bool is_real = k == 0 || 2 * k == spectrum.samples;
      for (std::size_t c = 0; c < channels; ++c) {
        const auto at = static_cast<Eigen::Index>(c);
        const int parts = is_real ? 1 : 2;
        run.log_determinant += parts * std::log(run.factor.back()(at, at).real());
        places_.insert(places_.end(), static_cast<std::size_t>(parts), {r, k, c});
      }
    }
    if (const WhitenedRoad* road = find_road(r)) {
      run.log_determinant += road->factor.diagonal().array().log().sum();
    }
    STRUT_CHECK(std::isfinite(run.log_determinant), "noise of finite covariance");
    runs_.push_back(std::move(run));
  }
  run_begin_.push_back(places_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (!has_road(r)) continue;
    Run& run = runs_[r];
    run.landing_basis = calc_landing_basis(r, roads_[r]->landings);
    run.share -= static_cast<double>(run.landing_basis.cols()) /
                 static_cast<double>(run_begin_[r + 1] - run_begin_[r]);
  }
}

Eigen::MatrixXd Whitener::calc_landing_basis(std::size_t r,
                                             const std::vector<LandingReading>& readings) const {
  // Frequencies up to a highest one hardly distinguish successive readings.
  constexpr double kRankTolerance = 0.01;
  const Run& run = runs_[r];
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(run.count),
                                                static_cast<Eigen::Index>(readings.size()));
  Eigen::Index used = 0;
  for (const LandingReading& at : readings) {
    if (at.time >= spectra_[r].samples) continue;
    const std::size_t row = run.rows[at.channel][at.time];
    if (row != kMissing) units(static_cast<Eigen::Index>(row), used++) = 1.0;
  }
  if (used == 0) return {};
  const Eigen::MatrixXd whitened = whiten_run(r, units.leftCols(used));
  // By white noise, so that drift of the sensors does not change what is removed (rewhiten_run).
  const Eigen::MatrixXd white = list_sensor_noise(r).asDiagonal() * whitened;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(white.transpose() * white);
  const double min_power = kRankTolerance * kRankTolerance * solver.eigenvalues()(used - 1);
  const auto rank = static_cast<Eigen::Index>((solver.eigenvalues().array() > min_power).count());
  if (rank == 0) return {};
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(whitened * solver.eigenvectors().rightCols(rank));
  return qr.householderQ() * Eigen::MatrixXd::Identity(whitened.rows(), rank);
}

Eigen::VectorXd Whitener::list_sensor_noise(std::size_t r) const {
  Eigen::VectorXd noise(static_cast<Eigen::Index>(run_begin_[r + 1] - run_begin_[r]));
  for (std::size_t i = run_begin_[r]; i < run_begin_[r + 1]; ++i) {
    const ReadingPlace& place = places_[i];
    const auto k = place.time - static_cast<std::size_t>(runs_[r].first);
    const auto channel = static_cast<Eigen::Index>(place.channel);
    noise(static_cast<Eigen::Index>(i - run_begin_[r])) =
        runs_[r].factor[k](channel, channel).real();
  }
  return noise;
}

double Whitener::get_frequency(const ReadingPlace& place) const {
  const NoiseSpectrum& s = spectra_[place.run];
  return static_cast<double>(place.time) / (static_cast<double>(s.samples) * s.interval);
}

Eigen::VectorXcd Whitener::get_sensor_direction(const ReadingPlace& place,
                                                std::size_t channel) const {
  const Run& run = runs_[place.run];
  const auto k = static_cast<std::size_t>(static_cast<Eigen::Index>(place.time) - run.first);
  const Eigen::Index count = run.factor[k].rows();
  return run.factor[k].triangularView<Eigen::Lower>().solve(
      Eigen::VectorXcd(Eigen::VectorXcd::Unit(count, static_cast<Eigen::Index>(channel))));
}

double Whitener::calc_log_likelihood(const Eigen::VectorXd& whitened, std::size_t run) const {
  const auto begin = static_cast<Eigen::Index>(run_begin_[run]);
  const auto count = static_cast<Eigen::Index>(run_begin_[run + 1]) - begin;
  return -0.5 * whitened.segment(begin, count).squaredNorm() - runs_[run].log_determinant;
}

void Whitener::apply_run(std::size_t r, const Eigen::Ref<const Eigen::VectorXd>& column,
                         Eigen::Ref<Eigen::VectorXd> out) const {
  const Run& run = runs_[r];
  const std::size_t channels = run.rows.size(), count = run.fade.size();
  const auto kept = static_cast<Eigen::Index>(run.factor.size());
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  Eigen::MatrixXcd spectrum(static_cast<Eigen::Index>(channels), kept);
  std::vector<double> series(count);
  std::vector<std::complex<double>> transform;
  for (std::size_t c = 0; c < channels; ++c) {
    bool is_zero = true;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t row = run.rows[c][i];
      series[i] = row == kMissing ? 0.0 : run.fade[i] * column(static_cast<Eigen::Index>(row));
      is_zero = is_zero && series[i] == 0.0;
    }
    const auto at = static_cast<Eigen::Index>(c);
    if (is_zero) {
      spectrum.row(at).setZero();
      continue;
    }
    fft.fwd(transform, series);
    const double scale = 1.0 / std::sqrt(static_cast<double>(count));
    for (Eigen::Index k = 0; k < kept; ++k) {
      spectrum(at, k) = scale * transform[static_cast<std::size_t>(run.first + k)];
    }
  }
  Eigen::Index row = 0;
  for (Eigen::Index k = 0; k < kept; ++k) {
    const Eigen::VectorXcd w =
        run.factor[static_cast<std::size_t>(k)].triangularView<Eigen::Lower>().solve(
            spectrum.col(k));
    const Eigen::Index frequency = run.first + k;
    const bool is_real = frequency == 0 || 2 * frequency == static_cast<Eigen::Index>(count);
    for (Eigen::Index c = 0; c < w.size(); ++c) {
      if (is_real) {
        out(row++) = w(c).real();
      } else {
        out(row++) = std::sqrt(2.0) * w(c).real();
        out(row++) = std::sqrt(2.0) * w(c).imag();
      }
    }
  }
}

Eigen::MatrixXd Whitener::whiten_run(std::size_t r, const Eigen::MatrixXd& columns,
                                     int threads) const {
  const auto count = static_cast<Eigen::Index>(run_begin_[r + 1] - run_begin_[r]);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, columns.cols());
  share_items(threads, static_cast<std::size_t>(columns.cols()), [&](std::size_t k, int) {
    const auto i = static_cast<Eigen::Index>(k);
    if (!columns.col(i).isZero(0.0)) apply_run(r, columns.col(i), out.col(i));
  });
  remove_landings(r, out);
  return out;
}

void Whitener::remove_landings(std::size_t r, Eigen::MatrixXd& whitened) const {
  const Eigen::MatrixXd& landing_basis = runs_[r].landing_basis;
  if (landing_basis.size() == 0) return;
  whitened -= landing_basis * (landing_basis.transpose() * whitened);
}

Eigen::MatrixXd Whitener::rewhiten_run(std::size_t r, Eigen::MatrixXd columns,
                                       const Whitener& before) const {
  STRUT_CHECK(has_road(r) && before.run_begin_ == run_begin_, "both whiten the same readings");
  columns = before.list_sensor_noise(r).cwiseQuotient(list_sensor_noise(r)).asDiagonal() * columns;
  // Both have the same landings: those that `before` removed span the same readings.
  remove_landings(r, columns);
  return columns;
}

Eigen::VectorXd Whitener::apply_sensors(std::size_t r, const Eigen::VectorXd& residual) const {
  const auto begin = static_cast<Eigen::Index>(runs_[r].begin);
  const auto count = static_cast<Eigen::Index>(runs_[r].count);
  return whiten_run(r, residual.segment(begin, count));
}

namespace {

/// Multiplies by X = (1 + L')^-1 L^-1.
template <class Matrix>
void solve_along(const WhitenedRoad& road, Matrix& along) {
  road.factor.triangularView<Eigen::Lower>().solveInPlace(along);
  road.raised.transpose().triangularView<Eigen::Upper>().solveInPlace(along);
}

}  // namespace

void Whitener::remove_roads(Eigen::MatrixXd& whitened, int threads) const {
  share_items(threads, roads_.size(), [&](std::size_t r, int) {
    const WhitenedRoad* road = find_road(r);
    if (road == nullptr) return;
    auto of_run = whitened.middleRows(static_cast<Eigen::Index>(run_begin_[r]),
                                      static_cast<Eigen::Index>(run_begin_[r + 1] - run_begin_[r]));
    Eigen::MatrixXd along = road->derivative.transpose() * of_run;
    solve_along(*road, along);
    of_run.noalias() -= road->derivative * along;
  });
}

Eigen::MatrixXd Whitener::apply(const Eigen::MatrixXd& columns, int threads) const {
  const auto readings = static_cast<Eigen::Index>(reading_count_);
  const auto whitened = static_cast<Eigen::Index>(places_.size());
  const Eigen::Index priors = columns.rows() - readings;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(whitened + priors, columns.cols());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const auto begin = static_cast<Eigen::Index>(run_begin_[r]);
    const auto count = static_cast<Eigen::Index>(run_begin_[r + 1]) - begin;
    out.middleRows(begin, count) =
        whiten_run(r,
                   Eigen::MatrixXd(columns.middleRows(static_cast<Eigen::Index>(runs_[r].begin),
                                                      static_cast<Eigen::Index>(runs_[r].count))),
                   threads);
  }
  remove_roads(out, threads);
  out.bottomRows(priors) = columns.bottomRows(priors);
  STRUT_CHECK(out.allFinite(), "finite residuals and derivatives");
  return out;
}

Eigen::VectorXd Whitener::apply_residual(const Eigen::VectorXd& residual) const {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(places_.size()), 1);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const auto begin = static_cast<Eigen::Index>(run_begin_[r]);
    const auto count = static_cast<Eigen::Index>(run_begin_[r + 1]) - begin;
    auto of_run = out.col(0).segment(begin, count);
    of_run = apply_sensors(r, residual);
    const WhitenedRoad* road = find_road(r);
    if (road == nullptr) continue;
    // (1 - H X H') (v - H w) = v - H (w + X (H' v - H'H w)) with H'H = L L' - 1: H, which is larger
    // than a cache, is read twice instead of three times.
    const Eigen::VectorXd& weights = roads_[r]->weights;
    const auto factor = road->factor.triangularView<Eigen::Lower>();
    Eigen::VectorXd along = road->derivative.transpose() * of_run;
    along -= factor * (factor.transpose() * weights) - weights;
    solve_along(*road, along);
    of_run.noalias() -= road->derivative * (weights + along);
  }
  const Eigen::Index priors = residual.size() - static_cast<Eigen::Index>(reading_count_);
  Eigen::VectorXd all(out.rows() + priors);
  all << out.col(0), residual.tail(priors);
  STRUT_CHECK(all.allFinite(), "finite residuals and derivatives");
  return all;
}

Linearization Whitener::apply(const Linearization& at, int threads) const {
  return {"", apply_residual(at.residual), apply(at.jacobian, threads)};
}

WhitenedModel::WhitenedModel(ReadingModel& model, const Whitener& whitener)
    : ReadingModel(model.unknowns()), model_(model), whitener_(whitener) {
  readings_ = whitener.places();
  channels_ = model.channels();
  prior_count_ = model.prior_count();
  outside_count_ = model.outside_count();
}

Linearization WhitenedModel::linearize(const std::vector<double>& values) {
  Linearization at = model_.linearize(values);
  simulation_count_ = model_.simulation_count();
  return at.failure.empty() ? whitener_.apply(at) : at;
}

std::vector<Evaluation> WhitenedModel::evaluate(const std::vector<std::vector<double>>& points) {
  std::vector<Evaluation> evaluations = model_.evaluate(points);
  simulation_count_ = model_.simulation_count();
  for (Evaluation& e : evaluations) {
    if (e.failure.empty()) e.residual = whitener_.apply_residual(e.residual);
  }
  return evaluations;
}

std::vector<double> WhitenedModel::align(const std::vector<double>& values) {
  return model_.align(values);
}

double WhitenedModel::calc_independent_count() const {
  double count = 0.0;
  for (std::size_t r = 0; r + 1 < whitener_.run_begin().size(); ++r) {
    count += whitener_.get_share(r) *
             static_cast<double>(whitener_.run_begin()[r + 1] - whitener_.run_begin()[r]);
  }
  return count;
}

double shrink_excess(double ratio, double count) {
  constexpr double kSigmas = 2.0;
  const double beyond = ratio - 1.0, limit = kSigmas * kSigmas * 2.0 / count;
  return beyond * beyond > limit ? 1.0 + std::max(0.0, beyond - limit / beyond) : 1.0;
}

void count_excess(const Whitener& whitener, const Eigen::VectorXd& whitened,
                  std::vector<NoiseSpectrum>& spectra) {
  constexpr double kEnough = 200.0;
  const std::size_t runs = whitener.spectra().size(), bands = kNoiseBands.size();
  // The last row is of all runs together.
  std::vector<std::vector<double>> sums(runs + 1, std::vector<double>(bands, 0.0)), counts = sums;
  for (std::size_t i = 0; i < whitener.whitened_count(); ++i) {
    const ReadingPlace& place = whitener.places()[i];
    const std::size_t band = find_noise_band(whitener.get_frequency(place));
    const double w = whitened(static_cast<Eigen::Index>(i));
    for (const std::size_t r : {place.run, runs}) {
      sums[r][band] += w * w * whitener.spectra()[place.run].excess[band];
      counts[r][band] += whitener.get_share(place.run);
    }
  }
  for (std::size_t r = 0; r < runs; ++r) {
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t from = counts[r][b] >= kEnough ? r : runs;
      const double count = counts[from][b];
      spectra[r].excess[b] = count > 0.0 ? shrink_excess(sums[from][b] / count, count) : 1.0;
    }
  }
}

}  // namespace strut
