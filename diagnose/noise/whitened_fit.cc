#include "diagnose/noise/whitened_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "diagnose/baseline/time_windows.h"
#include "diagnose/noise/chord_search.h"
#include "diagnose/noise/measure_color.h"
#include "estimate/fisher.h"

namespace strut {

SharedValues WhitenedFit::shared() const {
  const auto count = static_cast<std::ptrdiff_t>(shared_count);
  return {{fit.unknowns.begin(), fit.unknowns.begin() + count},
          {fit.values.begin(), fit.values.begin() + count}};
}

namespace {

/// Of a run before it meets its bump: by how much the mean square of each channel exceeds that of
/// its sensor, over that of a road with G0 = 1 m^3; the median of the channels. Nothing where too
/// little of the run comes before.
std::optional<double> measure_approach(const CampaignData& data, std::size_t run,
                                       std::size_t number, const ReadingModel& model,
                                       const NoiseSpectrum& spectrum,
                                       const Eigen::VectorXd& residual) {
  constexpr std::size_t kEnough = 50;  // samples
  const double end = make_time_windows(data, run).front().to;
  const std::size_t channels = spectrum.sigma.size();
  std::vector<double> squares(channels, 0.0), means(channels, 0.0);
  std::vector<std::size_t> counts(channels, 0);
  for (std::size_t k = 0; k < model.reading_count(); ++k) {
    const ReadingPlace& place = model.readings()[k];
    if (place.run != number || data.times(run)[place.time] >= end) continue;
    const double r = residual(static_cast<Eigen::Index>(k));
    squares[place.channel] += r * r;
    means[place.channel] += r;
    ++counts[place.channel];
  }
  std::vector<double> levels;
  for (std::size_t c = 0; c < channels; ++c) {
    if (counts[c] < kEnough) continue;
    // Variance of the channel over sigma^2 per m^3.
    const double unit = calc_common_variance(spectrum, c) / (spectrum.sigma[c] * spectrum.sigma[c]);
    const auto n = static_cast<double>(counts[c]);
    const double variance = squares[c] / n - (means[c] / n) * (means[c] / n);
    if (unit > 0.0) levels.push_back(std::max(0.0, variance - 1.0) / unit);
  }
  if (levels.empty()) return std::nullopt;
  std::sort(levels.begin(), levels.end());
  return levels[levels.size() / 2];
}

/// By runs over level ground, where there are some; else by what comes before the bumps, which no
/// effect of the car reaches.
Roughness measure_roughness(const CampaignData& data, const std::vector<std::size_t>& runs,
                            const ReadingModel& model, const std::vector<NoiseSpectrum>& spectra,
                            const Eigen::VectorXd& residual) {
  std::vector<bool> is_level;
  std::vector<double> approaches;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    is_level.push_back(!meets_bump(data, runs[i]));
    const auto level = measure_approach(data, runs[i], i, model, spectra[i], residual);
    if (level) approaches.push_back(*level);
  }
  if (std::find(is_level.begin(), is_level.end(), true) != is_level.end()) {
    return fit_roughness(model, spectra, is_level, residual);
  }
  constexpr double kResponseError = 0.02;
  if (approaches.empty()) return {0.0, kResponseError};
  std::sort(approaches.begin(), approaches.end());
  return {approaches[approaches.size() / 2], kResponseError};
}

}  // namespace

std::vector<NoiseSpectrum> measure_noise(const CampaignData& data, const Baseline& baseline) {
  std::vector<NoiseSpectrum> spectra =
      make_noise_spectra(data, baseline.runs, baseline.fit.unknowns, baseline.fit.values);
  const auto model = make_reading_model(data, baseline.runs, baseline.fit.unknowns);
  const Evaluation at = model->evaluate(baseline.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  if (!data.has_inputs()) {
    const Roughness roughness =
        measure_roughness(data, baseline.runs, *model, spectra, at.residual);
    for (NoiseSpectrum& s : spectra) {
      s.level = roughness.level;
      s.response_error = roughness.response_error;
    }
  }
  measure_color(*model, at.residual, spectra);
  return spectra;
}

namespace {

/// Where the inputs are recorded, what is beyond the sensors' noise is what is looked for: nothing
/// of it counts as noise.
void fit_driven(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  FitOptions options;
  options.start = start;
  const Whitener whitener(model, result.spectra);
  WhitenedModel whitened(model, whitener);
  result.fit = fit_readings(whitened, options);
  result.is_dominated = result.fit.chi2_per_degree() > kDominated;
}

/// The fit where the search stands, with derivatives of there; searches on where they see more of
/// a way than it should be.
void conclude(ChordSearch& search, ReadingModel& model, const Whitener& whitener,
              WhitenedFit& result) {
  constexpr int kTries = 3;
  const WhitenedModel whitened(model, whitener);
  for (int i = 0; i < kTries; ++i) {
    if (i > 0) search.search(whitener);
    search.renew();
    result.linearization = search.linearization();
    const Linearization at = {"", whitener.apply_residual(search.residual()),
                              whitener.apply(result.linearization->jacobian)};
    result.fit =
        describe_fit(whitened, at, search.values(), search.list_at_bound(), search.at_kink());
    if (result.fit.converged || search.at_kink()) break;
  }
  result.fit.iterations = search.steps();
  result.fit.simulations = model.simulation_count();
}

/// By the road's spectrum. A rough road excites what is not linear, too: what a band has beyond its
/// noise counts as noise. It is known only once the fit is there, and moves it.
void fit_crossing(ReadingModel& model, const std::vector<double>& start, WhitenedFit& result) {
  constexpr int kRounds = 2;
  ChordSearch search(model, start);
  for (int round = 0; round < kRounds; ++round) {
    const Whitener whitener(model, result.spectra);
    search.search(whitener);
    const Eigen::VectorXd residual = whitener.apply_residual(search.residual());
    if (round == 0) {
      result.is_dominated =
          residual.squaredNorm() > kDominated * static_cast<double>(residual.size());
      if (!result.is_dominated) {
        count_excess(whitener, residual, result.spectra);
        continue;
      }
    }
    conclude(search, model, whitener, result);
    break;
  }
}

/// Gauss-Newton over a car and the roads under its runs together.
class RoadSearch {
 public:
  RoadSearch(const CampaignData& data, const std::vector<Unknown>& unknowns,
             std::vector<double> start, bool is_level_known, int threads, WhitenedFit& result)
      : data_(data),
        unknowns_(unknowns),
        values_(std::move(start)),
        level_steps_(is_level_known ? kLevelSteps : 0),
        threads_(threads),
        result_(result) {
    for (NoiseSpectrum& s : result.spectra) s.excess.assign(s.excess.size(), 1.0);
  }

  /// Returns false where the car cannot be simulated on the road that it seems to need.
  bool run() {
    constexpr int kMostSteps = 12;
    // Predicted decrease of chi2 below which the search ends. Contact events that pass a reading
    // make chi2 discontinuous by about as much.
    constexpr double kNear = 30.0;
    // The derivatives by the road are kept after a step whose predicted decrease is below kSmall
    // of chi2 and that achieves more than kEnough of it.
    constexpr double kSmall = 0.05, kEnough = 0.25;
    bool is_new = true;
    int steps = 0;
    while (steps < kMostSteps) {
      make_model();
      const bool was_new = is_new;
      const std::optional<Move> proposed = propose(is_new);
      if (!proposed) return false;
      const Move& move = *proposed;
      const double gained = take(move);
      ++steps;
      if (move.promised < kNear) break;
      const bool is_enough = gained > kEnough * move.promised;
      if (!is_enough && was_new && steps > 1) break;
      is_new = !is_enough || move.promised > kSmall * move.cost;
      if (level_steps_++ < kLevelSteps) measure_level(move);
    }
    describe(steps);
    return true;
  }

 private:
  struct Move {
    std::vector<double> values;            // of the unknowns
    std::vector<Eigen::VectorXd> weights;  // of the roads, by run
    double cost = 0.0, promised = 0.0;     // chi2 here; by how much it is to fall
  };

  void make_model() {
    model_ = make_reading_model(data_, result_.runs, result_.roads, unknowns_, threads_);
  }

  /// Sets the response of the roads where they and the car are; false where these cannot be
  /// simulated.
  bool renew_responses(const Whitener& sensors) {
    const double level = result_.spectra.front().level;
    for (std::size_t r = 0; r < result_.runs.size(); ++r) {
      const LatentRoad& road = *result_.roads[r];
      Eigen::MatrixXd columns(
          static_cast<Eigen::Index>(sensors.run_begin()[r + 1] - sensors.run_begin()[r]),
          road.weights.size());
      const std::string failure =
          model_->linearize_road(values_, r, [&](Eigen::Index first, const Eigen::MatrixXd& part) {
            columns.middleCols(first, part.cols()) = sensors.whiten_run(r, part);
          });
      if (!failure.empty()) return false;
      columns = std::sqrt(level) * road.prior->apply_transposed(columns);
      result_.roads[r] = set_response(road, std::move(columns));
    }
    return true;
  }

  Linearization linearize() {
    Linearization at = model_->linearize(values_);
    if (!at.failure.empty()) throw InputError(at.failure);
    return at;
  }

  std::optional<Move> propose(bool is_new) {
    const Whitener sensors(*model_, result_.spectra, result_.roads);
    if (is_new && !renew_responses(sensors)) return std::nullopt;
    const Linearization at = linearize();
    const Whitener whitener(*model_, result_.spectra, result_.roads);
    const WhitenedModel whitened(*model_, whitener);
    const NormalEquations normal = calc_normal_equations(whitened, whitener.apply(at));
    const NormalEquations free = free_unknowns(normal, list_held(normal.gradient));
    const Eigen::VectorXd change =
        -(invert_information(free.information).covariance * free.gradient);
    Move move;
    move.values = values_;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Unknown& u = unknowns_[i];
      move.values[i] =
          std::clamp(values_[i] + u.scale * change(static_cast<Eigen::Index>(i)), u.low, u.high);
    }
    const Eigen::VectorXd moved = at.residual + at.jacobian * change;
    move.cost = calc_prior_cost(at.residual);
    double after = calc_prior_cost(moved);
    for (std::size_t r = 0; r < result_.runs.size(); ++r) {
      const LatentRoad& road = *result_.roads[r];
      const Eigen::VectorXd there = sensors.apply_sensors(r, moved);
      Eigen::VectorXd weights = solve_weights(road, there);
      move.cost += sensors.apply_sensors(r, at.residual).squaredNorm() + road.weights.squaredNorm();
      after +=
          (there + road.response * (weights - road.weights)).squaredNorm() + weights.squaredNorm();
      move.weights.push_back(std::move(weights));
    }
    move.promised = move.cost - after;
    return move;
  }

  double calc_prior_cost(const Eigen::VectorXd& residual) const {
    const auto readings = static_cast<Eigen::Index>(model_->reading_count());
    return residual.tail(residual.size() - readings).squaredNorm();
  }

  /// Unknowns on a bound, with a descent direction beyond it.
  std::vector<bool> list_held(const Eigen::VectorXd& gradient) const {
    std::vector<bool> held;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double slope = gradient(static_cast<Eigen::Index>(i));
      const bool is_low = values_[i] <= unknowns_[i].low && slope > 0.0;
      held.push_back(is_low || (values_[i] >= unknowns_[i].high && slope < 0.0));
    }
    return held;
  }

  /// chi2 of readings, priors and roads; infinite where a run cannot be simulated.
  double calc_cost(const std::vector<double>& values) {
    make_model();
    const Evaluation there = model_->evaluate(values);
    if (!there.failure.empty()) return std::numeric_limits<double>::infinity();
    const Whitener sensors(*model_, result_.spectra, result_.roads);
    double cost = calc_prior_cost(there.residual);
    for (std::size_t r = 0; r < result_.roads.size(); ++r) {
      cost += sensors.apply_sensors(r, there.residual).squaredNorm() +
              result_.roads[r]->weights.squaredNorm();
    }
    return cost;
  }

  /// Moves car and roads as far as that lowers chi2; returns by how much it falls.
  double take(const Move& move) {
    const double level = result_.spectra.front().level;
    const LatentRoads before = result_.roads;
    for (const double share : {1.0, 0.3, 0.1, 0.03}) {
      std::vector<double> values = values_;
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] += share * (move.values[i] - values[i]);
      }
      for (std::size_t r = 0; r < before.size(); ++r) {
        const Eigen::VectorXd& from = before[r]->weights;
        result_.roads[r] = move_road(*before[r], from + share * (move.weights[r] - from), level);
      }
      const double gained = move.cost - calc_cost(values);
      if (!(gained > 0.0)) continue;
      values_ = std::move(values);
      return gained;
    }
    result_.roads = before;
    return 0.0;
  }

  /// The level at which the roads found are most likely: a step to the fixed point of
  /// |w|^2 = number of weights that the readings determine (D. J. C. MacKay, Neural Computation 4
  /// (1992)).
  void measure_level(const Move& move) {
    double sum = 0.0, count = 0.0;
    for (std::size_t r = 0; r < result_.roads.size(); ++r) {
      sum += move.weights[r].squaredNorm();
      count += count_determined(*result_.roads[r]);
    }
    constexpr double kMost = 4.0;  // far from the minimum, a road takes what the car should
    const double factor = std::clamp(sum / count, 1.0 / kMost, kMost);
    for (NoiseSpectrum& s : result_.spectra) s.level *= factor;
    for (std::shared_ptr<const LatentRoad>& road : result_.roads) {
      road = move_road(*set_response(*road, std::sqrt(factor) * road->response),
                       road->weights / std::sqrt(factor), result_.spectra.front().level);
    }
  }

  /// The fit where the search ended. Events that readings pass leave single runs' clocks and speeds
  /// some standard deviations beside what the linear model wants; what all runs share has converged
  /// where that wants no more of it.
  void describe(int steps) {
    make_model();
    const Whitener whitener(*model_, result_.spectra, result_.roads);
    const WhitenedModel whitened(*model_, whitener);
    result_.linearization = std::make_shared<const Linearization>(linearize());
    const Linearization at = whitener.apply(*result_.linearization);
    result_.is_dominated =
        at.residual.squaredNorm() > kDominated * static_cast<double>(at.residual.size());
    std::vector<bool> at_bound;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      at_bound.push_back(values_[i] <= unknowns_[i].low || values_[i] >= unknowns_[i].high);
    }
    result_.fit = describe_fit(whitened, at, values_, at_bound, true);
    const NormalEquations free =
        free_unknowns(calc_normal_equations(whitened, at), result_.fit.at_bound);
    const Eigen::MatrixXd covariance = invert_information(free.information).covariance;
    const Eigen::VectorXd change = covariance * free.gradient;
    double most = 0.0;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(result_.shared_count); ++i) {
      if (covariance(i, i) > 0.0) {
        most = std::max(most, std::abs(change(i)) / std::sqrt(covariance(i, i)));
      }
    }
    result_.fit.distance = most;
    result_.fit.converged = most < kKinkTolerance;
    result_.fit.iterations = steps;
  }

  static constexpr int kLevelSteps = 4;
  const CampaignData& data_;
  const std::vector<Unknown>& unknowns_;
  std::vector<double> values_;
  int level_steps_, threads_;
  WhitenedFit& result_;
  std::unique_ptr<ReadingModel> model_;
};

/// Throws InputError where chi2 is not finite, with the run and the channel of the first residual
/// that is not.
void check_finite(const CampaignData& data, ReadingModel& model, const WhitenedFit& result) {
  if (std::isfinite(result.fit.chi2)) return;
  const Evaluation at = model.evaluate(result.fit.values);
  if (!at.failure.empty()) throw InputError(at.failure);
  for (std::size_t i = 0; i < model.reading_count(); ++i) {
    if (std::isfinite(at.residual(static_cast<Eigen::Index>(i)))) continue;
    const ReadingPlace& place = model.readings()[i];
    const std::size_t run = result.runs[place.run];
    throw InputError(fmt::format(
        "{}: {}: the residual at {:.6g} s is not finite", data.campaign.runs[run].name,
        data.info(data.channels(run)[place.channel].channel).name, data.times(run)[place.time]));
  }
  throw InputError(fmt::format("{}: chi2 of the fit is not finite", data.campaign.path.string()));
}

}  // namespace

WhitenedFit fit_whitened(const CampaignData& data, const std::vector<std::size_t>& runs,
                         const RunNoise& noise, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& start, std::size_t shared_count, int threads) {
  WhitenedFit result;
  result.runs = runs;
  result.spectra = noise.spectra;
  result.roads = noise.roads;
  result.shared_count = shared_count;
  if (!result.roads.empty() &&
      !RoadSearch(data, unknowns, start, noise.is_level_known, threads, result).run()) {
    result.spectra = noise.spectra;
    result.roads.clear();
  }
  const auto model = make_reading_model(data, runs, result.roads, unknowns, threads);
  if (data.has_inputs()) {
    fit_driven(*model, start, result);
  } else if (result.roads.empty()) {
    fit_crossing(*model, start, result);
  }
  check_finite(data, *model, result);
  return result;
}

}  // namespace strut
