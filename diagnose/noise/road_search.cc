#include "diagnose/noise/road_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "diagnose/noise/measure_color.h"
#include "estimate/fisher.h"

namespace strut {
namespace {

class RoadSearch {
 public:
  RoadSearch(const CampaignData& data, const std::vector<Unknown>& unknowns,
             std::vector<double> start, bool is_noise_known, int threads, WhitenedFit& result)
      : data_(data),
        unknowns_(unknowns),
        values_(std::move(start)),
        is_noise_known_(is_noise_known),
        threads_(threads),
        result_(result) {
    for (NoiseSpectrum& s : result.spectra) {
      s.excess.assign(s.excess.size(), 1.0);
      if (is_noise_known_) continue;
      // Measured with the road as noise, it would contain what the sensors read of the road.
      for (SensorColor& color : s.color) color.corner = 0.0;
    }
  }

  /// Returns false where the car cannot be simulated on the road that it seems to need.
  bool run() {
    make_model();
    if (!descend(true)) return false;
    if (!is_noise_known_) {
      const WhitenedFit found = result_;
      const std::vector<double> values = values_;
      if (measure_drift() && !descend(false)) {
        result_ = found;
        values_ = values;
        is_fresh_ = false;
        make_model();
        if (!descend(true)) return false;
      }
    }
    settle();
    describe();
    return true;
  }

 private:
  /// Predicted decrease of chi2 below which the search ends. Contact events that pass a reading
  /// make chi2 discontinuous by about as much.
  static constexpr double kUneven = 30.0;

  /// Searches the minimum; begins with new derivatives if `is_new`, else with the last ones.
  /// Returns false where the car cannot be simulated on the road that it seems to need.
  bool descend(bool is_new) {
    constexpr int kMaxSteps = 12, kLevelSteps = 4;
    // The derivatives, of which those by the road cost most, are kept after a step that achieves
    // more than kNearly of what it promised, or more than kEnough where that is below kSmall of
    // chi2.
    constexpr double kSmall = 0.05, kEnough = 0.25, kNearly = 0.8;
    int level_steps = is_noise_known_ ? 0 : kLevelSteps;
    for (int steps = 1; steps <= kMaxSteps; ++steps) {
      const bool was_new = is_new;
      const std::optional<Move> proposed = propose(is_new);
      if (!proposed) return false;
      const Move& move = *proposed;
      const double gained = take(move, 0.0).value_or(0.0);
      ++steps_;
      moved_ += std::max(gained, 0.0);
      if (move.promised < kUneven) {
        // The responses decide which part of a residual a road can take, here and not where the
        // search began.
        if (moved_ < kSmall * move.cost) break;
        is_new = true;
        continue;
      }
      const bool is_enough = gained > kEnough * move.promised;
      if (!is_enough && was_new && steps > 1) break;
      const bool is_near = gained > kNearly * move.promised;
      is_new = !is_near && (!is_enough || move.promised > kSmall * move.cost);
      if (level_steps > 0 && measure_level(move)) --level_steps;
    }
    return true;
  }

  /// Returns whether the sensors drift; then whitens the roads' responses again.
  bool measure_drift() {
    const Whitener before(*model_, result_.spectra, result_.roads);
    if (!measure_drift_beside_roads(*model_, before, here_->residual, result_.spectra, threads_)) {
      return false;
    }
    const Whitener after(*model_, result_.spectra, result_.roads);
    share_items(threads_, result_.roads.size(), [&](std::size_t r, int) {
      const LatentRoad& road = *result_.roads[r];
      result_.roads[r] =
          set_response(road, after.rewhiten_run(r, road.whitened->derivative, before));
    });
    return true;
  }

  struct Move {
    std::vector<double> values;            // of the unknowns
    std::vector<Eigen::VectorXd> weights;  // of the roads, by run
    double cost = 0.0, promised = 0.0;     // chi2 here; by how much it is to fall
    double distance = 0.0;                 // largest change of a shared unknown, as calc_distance
  };

  /// Sets the model of the roads as they are now.
  void make_model() {
    model_ = make_reading_model(data_, result_.runs, result_.roads, unknowns_, threads_);
  }

  /// Sets the landings and the responses of the roads where they and the car are. Returns false
  /// where the car cannot be simulated.
  bool renew_responses() {
    moved_ = 0.0;
    const std::size_t runs = result_.runs.size();
    share_items(threads_, runs, [&](std::size_t r, int) {
      result_.roads[r] =
          note_landings(data_, result_.runs[r], *result_.roads[r], unknowns_, values_, r);
    });
    const Whitener sensors(*model_, result_.spectra, result_.roads);
    std::vector<Eigen::MatrixXd> columns(runs);
    std::atomic<bool> has_failed{false};
    // Driving over a road cannot be shared, the changed sections can.
    share_large_items(threads_, runs, [&](std::size_t r, int inside) {
      columns[r].resize(
          static_cast<Eigen::Index>(sensors.run_begin()[r + 1] - sensors.run_begin()[r]),
          result_.roads[r]->weights.size());
      const auto take = [&](Eigen::Index first, const Eigen::MatrixXd& part) {
        columns[r].middleCols(first, part.cols()) = sensors.whiten_run(r, part, inside);
      };
      if (!model_->linearize_road(values_, r, take).empty()) has_failed = true;
    });
    if (has_failed) return false;
    const double scale = std::sqrt(result_.spectra.front().level);
    share_items(threads_, runs, [&](std::size_t r, int) {
      const LatentRoad& road = *result_.roads[r];
      result_.roads[r] = set_response(road, scale * road.prior->apply_transposed(columns[r]));
    });
    return true;
  }

  /// The linearization at the current values and roads.
  const Linearization& linearize() {
    if (!is_fresh_) {
      here_ = std::make_shared<const Linearization>(model_->linearize(values_));
      if (!here_->failure.empty()) throw InputError(here_->failure);
      is_fresh_ = true;
    }
    return *here_;
  }

  std::optional<Move> propose(bool is_new) {
    if (is_new && !renew_responses()) return std::nullopt;
    return propose_from(is_new ? linearize() : *here_);
  }

  Move propose_from(const Linearization& at) const {
    const Whitener whitener(*model_, result_.spectra, result_.roads);
    const WhitenedModel whitened(*model_, whitener);
    const NormalEquations normal = calc_normal_equations(whitened, whitener.apply(at, threads_));
    const NormalEquations free = free_unknowns(normal, list_held(normal.gradient));
    const Eigen::MatrixXd covariance = invert_information(free.information).covariance;
    const Eigen::VectorXd change = -(covariance * free.gradient);
    Move move;
    move.distance = calc_distance(covariance, change);
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
      const Eigen::VectorXd there = whitener.apply_sensors(r, moved);
      Eigen::VectorXd weights = solve_weights(road, there);
      move.cost +=
          whitener.apply_sensors(r, at.residual).squaredNorm() + road.weights.squaredNorm();
      after += (there + road.whitened->derivative * (weights - road.weights)).squaredNorm() +
               weights.squaredNorm();
      move.weights.push_back(std::move(weights));
    }
    move.promised = move.cost - after;
    return move;
  }

  /// The largest change of an unknown that all runs share, in its standard deviations.
  double calc_distance(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& change) const {
    double most = 0.0;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(result_.shared_count); ++i) {
      if (covariance(i, i) > 0.0) {
        most = std::max(most, std::abs(change(i)) / std::sqrt(covariance(i, i)));
      }
    }
    return most;
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

  /// chi2 of readings, priors and roads there.
  double calc_cost(const Eigen::VectorXd& residual) const {
    const Whitener sensors(*model_, result_.spectra, result_.roads);
    double cost = calc_prior_cost(residual);
    for (std::size_t r = 0; r < result_.roads.size(); ++r) {
      cost += sensors.apply_sensors(r, residual).squaredNorm() +
              result_.roads[r]->weights.squaredNorm();
    }
    return cost;
  }

  /// Moves car and roads as far as that lowers chi2, or raises it by less than `uneven`; returns by
  /// how much it falls, or nothing where they stay.
  std::optional<double> take(const Move& move, double uneven) {
    const double level = result_.spectra.front().level;
    const LatentRoads before = result_.roads;
    for (const double fraction : {1.0, 0.3, 0.1, 0.03}) {
      std::vector<double> values = values_;
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] += fraction * (move.values[i] - values[i]);
      }
      for (std::size_t r = 0; r < before.size(); ++r) {
        const Eigen::VectorXd& from = before[r]->weights;
        result_.roads[r] = move_road(*before[r], from + fraction * (move.weights[r] - from), level);
      }
      make_model();
      Evaluation there = model_->evaluate(values);
      if (!there.failure.empty()) continue;
      const double gained = move.cost - calc_cost(there.residual);
      if (!(gained > -uneven)) continue;
      here_ = std::make_shared<const Linearization>(
          Linearization{"", std::move(there.residual), here_->jacobian});
      is_fresh_ = false;
      values_ = std::move(values);
      return gained;
    }
    result_.roads = before;
    make_model();
    return std::nullopt;
  }

  /// Takes full steps of the linear model, even if chi2 rises a little: contact events make chi2
  /// uneven, so that a search which only descends ends before it reaches the minimum of all
  /// readings. The steps are small: derivatives of before serve all of them.
  void settle() {
    if (result_.shared_count == 0) return;
    constexpr int kMaxSteps = 5;
    constexpr double kNearSigmas = 0.05;
    linearize();
    for (int i = 0; i < kMaxSteps; ++i) {
      const Move move = propose_from(*here_);
      if (move.distance < kNearSigmas || !take(move, kUneven)) break;
    }
  }

  /// The level at which the roads found are most likely: a step to the fixed point of
  /// |w|^2 = number of weights that the readings determine (D. J. C. MacKay, Neural Computation 4
  /// (1992)). Returns whether it has changed.
  bool measure_level(const Move& move) {
    std::vector<double> determined(result_.roads.size());
    share_items(threads_, determined.size(),
                [&](std::size_t r, int) { determined[r] = count_determined(*result_.roads[r]); });
    double sum = 0.0, count = 0.0;
    for (std::size_t r = 0; r < determined.size(); ++r) {
      sum += move.weights[r].squaredNorm();
      count += determined[r];
    }
    constexpr double kMaxFactor = 4.0;  // far from the minimum, a road takes what the car should
    constexpr double kSame = 0.01;
    const double factor = std::clamp(sum / count, 1.0 / kMaxFactor, kMaxFactor);
    if (std::abs(factor - 1.0) < kSame) return false;
    for (NoiseSpectrum& s : result_.spectra) s.level *= factor;
    share_items(threads_, determined.size(), [&](std::size_t r, int) {
      const LatentRoad& road = *result_.roads[r];
      result_.roads[r] =
          move_road(*set_response(road, std::sqrt(factor) * road.whitened->derivative),
                    road.weights / std::sqrt(factor), result_.spectra.front().level);
    });
    make_model();
    return true;
  }

  /// The fit where the search ended. Events that readings pass leave single runs' clocks and speeds
  /// some standard deviations beside what the linear model wants; what all runs share has converged
  /// where that wants no more of it.
  void describe() {
    const Whitener whitener(*model_, result_.spectra, result_.roads);
    const WhitenedModel whitened(*model_, whitener);
    const Linearization at = whitener.apply(linearize(), threads_);
    result_.linearization = here_;
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
    result_.fit.distance = calc_distance(covariance, covariance * free.gradient);
    result_.fit.converged = result_.fit.distance < kKinkTolerance;
    result_.fit.iterations = steps_;
  }

  const CampaignData& data_;
  const std::vector<Unknown>& unknowns_;
  std::vector<double> values_;
  bool is_noise_known_;
  int threads_, steps_ = 0;
  WhitenedFit& result_;
  std::unique_ptr<ReadingModel> model_;
  /// Where the search stands; the derivatives may be those of before.
  std::shared_ptr<const Linearization> here_;
  bool is_fresh_ = false;
  double moved_ = 0.0;  // fall of chi2 since the roads' responses were taken
};

}  // namespace

bool search_roads(const CampaignData& data, const std::vector<Unknown>& unknowns,
                  std::vector<double> start, bool is_noise_known, int threads,
                  WhitenedFit& result) {
  return RoadSearch(data, unknowns, std::move(start), is_noise_known, threads, result).run();
}

}  // namespace strut
