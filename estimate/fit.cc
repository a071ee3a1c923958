#include "estimate/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error/input_error.h"
#include "base/least_squares/levenberg_marquardt.h"
#include "estimate/fisher.h"
#include "estimate/readings.h"
#include "estimate/uneven_residual.h"

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The value at a weight (value - start) / scale, which may lie beyond a bound.
double calc_free_value(const Unknown& u, double weight) { return u.start + weight * u.scale; }

/// Values at weights; beyond a bound a value stays on it.
std::vector<double> calc_values(const std::vector<Unknown>& unknowns, const double* weights) {
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    values.push_back(std::clamp(calc_free_value(u, weights[i]), u.low, u.high));
  }
  return values;
}

/// Weights where the search starts: the unknowns' own initial guesses, with aligned clocks.
std::vector<double> make_start(ReadingModel& model, const FitOptions& options) {
  std::vector<double> weights =
      model.align(options.start.empty() ? list_starts(model.unknowns()) : options.start);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Unknown& u = model.unknowns()[i];
    weights[i] = (weights[i] - u.start) / u.scale;
  }
  return weights;
}

/// By how much, in its scale, a weight exceeds its upper (or lower) bound; negative inside.
double calc_above(const Unknown& u, double weight) {
  return (calc_free_value(u, weight) - u.high) / u.scale;
}
double calc_below(const Unknown& u, double weight) {
  return (u.low - calc_free_value(u, weight)) / u.scale;
}

/// Which weights a bound holds: those beyond it, and those on it from where chi2 falls outwards.
std::vector<bool> list_held(const std::vector<Unknown>& unknowns, const double* weights,
                            const Eigen::VectorXd& gradient) {
  constexpr double kOn = 1e-9;
  std::vector<bool> held;
  held.reserve(unknowns.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double above = calc_above(unknowns[i], weights[i]),
                 below = calc_below(unknowns[i], weights[i]);
    const double slope = gradient(static_cast<Eigen::Index>(i));
    held.push_back(above > kOn || below > kOn || (above > -kOn && slope < 0.0) ||
                   (below > -kOn && slope > 0.0));
  }
  return held;
}

/// The linear model at one point.
struct FitPoint {
  std::vector<double> values;
  Linearization at;
  NormalEquations normal;  // empty where `at` failed

  bool failed() const { return !at.failure.empty(); }
};

/// The model as the search sees it, by weights. Keeps the last point: a search asks for the loss of
/// a point, and for its gradient if it accepts it.
class FitProblem : public LeastSquaresProblem {
 public:
  explicit FitProblem(ReadingModel& model) : model_(model) {}

  std::size_t weight_count() const override { return model_.unknowns().size(); }
  double residual_count() const override {
    return static_cast<double>(model_.reading_count() + model_.prior_count());
  }

  double calc_gram(const double* weights, int /*epoch*/, double* h, double* gradient) override {
    const auto n = static_cast<Eigen::Index>(weight_count());
    const FitPoint& point = linearize(weights);
    if (point.failed()) return kInfinity;
    const NormalEquations normal = free_unknowns(point.normal, list_held(weights));
    Eigen::Map<Eigen::MatrixXd>(h, n, n) = normal.information;
    Eigen::Map<Eigen::VectorXd>(gradient, n) = normal.gradient;
    return point.at.residual.squaredNorm();
  }

  /// Infinite where the point or a neighbor in its differences cannot be simulated, so that the
  /// step is rejected. Trial points are linearized, since most are accepted and then need their
  /// Jacobian.
  double calc_loss(const double* weights) override {
    const FitPoint& point = linearize(weights);
    return point.failed() ? kInfinity : point.at.residual.squaredNorm();
  }

  const FitPoint& linearize(const double* weights) {
    std::vector<double> values = calc_values(model_.unknowns(), weights);
    if (values == last_.values) return last_;
    last_.at = model_.linearize(values);
    last_.values = std::move(values);
    if (!last_.failed()) last_.normal = calc_normal_equations(model_, last_.at);
    return last_;
  }

  /// Which weights a bound holds there; the model must not fail there.
  std::vector<bool> list_held(const double* weights) {
    return strut::list_held(model_.unknowns(), weights, linearize(weights).normal.gradient);
  }

  const ReadingModel& model() const { return model_; }

 private:
  ReadingModel& model_;
  FitPoint last_;
};

double calc_distance(FitProblem& problem, const double* weights) {
  const FitPoint& point = problem.linearize(weights);
  if (point.failed()) return kInfinity;
  return calc_distance(free_unknowns(point.normal, problem.list_held(weights)));
}

double calc_widening(FitProblem& problem, const double* weights) {
  const FitPoint& point = problem.linearize(weights);
  return point.failed() ? 1.0 : calc_widening(problem.model(), point.at);
}

/// Moves a weight beyond a bound back to it if chi2 decreases inwards; returns whether there was
/// one.
bool release_bounds(FitProblem& problem, std::vector<double>& weights) {
  const FitPoint& point = problem.linearize(weights.data());
  if (point.failed()) return false;
  const std::vector<Unknown>& unknowns = problem.model().unknowns();
  bool inwards = false;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Unknown& u = unknowns[i];
    const bool above = calc_above(u, weights[i]) > 0.0;
    if (!above && !(calc_below(u, weights[i]) > 0.0)) continue;
    const double slope = point.normal.gradient(static_cast<Eigen::Index>(i));
    if ((above && slope <= 0.0) || (!above && slope >= 0.0)) continue;
    weights[i] = ((above ? u.high : u.low) - u.start) / u.scale * (1.0 - 1e-12);
    inwards = true;
  }
  return inwards;
}

LevenbergMarquardtOptions make_search_options(int iterations, double first_damping,
                                              double max_damping) {
  LevenbergMarquardtOptions search;
  search.scale = DampingScale::kDiagonal;
  search.accelerate = false;
  search.first_damping = first_damping;
  search.max_damping = max_damping;
  search.epochs = std::max(0, iterations);
  search.min_gradient = 0.0;
  return search;
}

/// When a search stops.
struct Goal {
  double distance = 0.0;  // from the minimum, in standard deviations
  bool widened = false;   // whether these are widened by calc_widening
  double max_damping = 0.0;
};

/// State of a search.
struct SearchState {
  std::vector<double> weights;
  int iterations = 0;
};

/// Steps until the goal is reached; returns false where no damping lowers chi2 any more.
bool approach(FitProblem& problem, const FitOptions& options, const Goal& goal,
              SearchState& state) {
  LevenbergMarquardt search(problem, nullptr,
                            make_search_options(options.iterations - state.iterations,
                                                options.first_damping, goal.max_damping));
  search.start(state.weights);
  const auto is_far = [&] {
    const double* at = search.state().weights.data();
    return calc_distance(problem, at) >
           goal.distance * (goal.widened ? calc_widening(problem, at) : 1.0);
  };
  while (is_far() && search.step()) {
  }
  state.weights = search.state().weights;
  state.iterations += search.state().epoch;
  return search.state().stop != StopReason::kDamping;
}

/// Approaches the minimum; returns whether it ends at a kink. The second approach stops at lower
/// damping: close to the minimum the loss has kinks, where a contact event passes a reading, and
/// the last hundredths of a standard deviation of the linear model may not exist.
bool search_minimum(FitProblem& problem, const FitOptions& options, SearchState& state) {
  constexpr int kReleases = 3;
  constexpr Goal kNear{kFitTolerance, true, 1e6}, kNearest{0.01 * kFitTolerance, false, 1e-3};
  bool at_kink = false;
  for (int pass = 0; pass <= kReleases; ++pass) {
    at_kink = !approach(problem, options, kNear, state);
    approach(problem, options, kNearest, state);
    if (!release_bounds(problem, state.weights)) break;
  }
  return at_kink;
}

std::vector<ChannelFit> describe_channels(const ReadingModel& model,
                                          const Eigen::VectorXd& residual) {
  std::vector<ChannelFit> fits;
  for (std::size_t r = 0; r < model.channels().size(); ++r) {
    const std::vector<int>& channels = model.channels()[r];
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ChannelFit fit{static_cast<int>(r), channels[c]};
      double last = 0.0, products = 0.0;
      for (std::size_t k = 0; k < model.reading_count(); ++k) {
        const ReadingPlace& place = model.readings()[k];
        if (place.run != r || place.channel != c) continue;
        const double e = residual(static_cast<Eigen::Index>(k));
        ++fit.count;
        fit.chi2 += e * e;
        products += e * last;
        last = e;
      }
      fit.neighbor_correlation = fit.chi2 > 0.0 ? products / fit.chi2 : 0.0;
      fits.push_back(fit);
    }
  }
  return fits;
}

Uncertainty calc_widened(const ReadingModel& model, const Linearization& at,
                         const NormalEquations& normal, const FitResult& result) {
  const double misfit = std::max(1.0, result.chi2_per_degree());
  Eigen::MatrixXd priors = normal.of_priors;
  // The prior of a force map is in units of the residual (map_prior.h).
  for (std::size_t i = 0; i < result.unknowns.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (result.unknowns[i].kind == UnknownKind::kForceMap) priors(k, k) /= misfit;
  }
  const Eigen::MatrixXd information = (normal.information - normal.of_priors) / misfit + priors;
  Uncertainty widened = calc_uncertainty(information, result.unknowns);
  if (result.degrees <= 0) return widened;
  // The directions that nothing identifies stay those of the readings.
  const Eigen::VectorXd growth =
      calc_growth(model, at, invert_information(information).covariance, priors, misfit);
  widened.covariance = growth.asDiagonal() * widened.covariance * growth.asDiagonal();
  for (std::size_t i = 0; i < result.unknowns.size(); ++i) {
    widened.sigma[i] *= growth(static_cast<Eigen::Index>(i));
    widened.identifiable[i] = is_identifiable(widened.sigma[i], result.unknowns[i]);
  }
  return widened;
}

}  // namespace

NormalEquations free_unknowns(NormalEquations normal, const std::vector<bool>& at_bound) {
  for (std::size_t i = 0; i < at_bound.size(); ++i) {
    if (!at_bound[i]) continue;
    const auto at = static_cast<Eigen::Index>(i);
    normal.information.row(at).setZero();
    normal.information.col(at).setZero();
    normal.gradient(at) = 0.0;
  }
  return normal;
}

double calc_distance(const NormalEquations& normal) {
  const InformationInverse inverse = invert_information(normal.information);
  return std::sqrt(std::max(0.0, normal.gradient.dot(inverse.covariance * normal.gradient)));
}

double calc_widening(const ReadingModel& model, const Linearization& at) {
  const double degrees = model.calc_independent_count() + static_cast<double>(model.prior_count()) -
                         static_cast<double>(model.unknowns().size());
  return degrees > 0.0 ? std::sqrt(std::max(1.0, at.residual.squaredNorm() / degrees)) : 1.0;
}

FitResult describe_fit(const ReadingModel& model, const Linearization& at,
                       std::vector<double> values, std::vector<bool> at_bound, bool at_kink) {
  FitResult result;
  result.unknowns = model.unknowns();
  result.values = std::move(values);
  result.at_bound = std::move(at_bound);
  result.at_kink = at_kink;
  const NormalEquations normal = calc_normal_equations(model, at);
  result.uncertainty = calc_uncertainty(normal.information, result.unknowns);
  result.chi2 = at.residual.squaredNorm();
  result.degrees = std::lround(model.calc_independent_count()) +
                   static_cast<long>(model.prior_count()) - result.uncertainty.rank;
  result.widened = calc_widened(model, at, normal, result);
  result.channels = describe_channels(model, at.residual);
  result.distance =
      calc_distance(free_unknowns(normal, result.at_bound)) / calc_widening(model, at);
  result.converged = result.distance < (at_kink ? kKinkTolerance : kFitTolerance);
  result.simulations = model.simulation_count();
  result.outside = static_cast<long>(model.outside_count());
  return result;
}

double FitResult::chi2_per_degree() const {
  return degrees > 0 ? chi2 / static_cast<double>(degrees) : 0.0;
}

double FitResult::calc_excess() const {
  const auto expected = static_cast<double>(degrees);
  return degrees > 0 ? (chi2 - expected) / std::sqrt(2.0 * expected) : 0.0;
}

FitResult fit_readings(ReadingModel& model, const FitOptions& options) {
  FitProblem problem(model);
  SearchState state{make_start(model, options), 0};
  const std::string failure = problem.linearize(state.weights.data()).at.failure;
  if (!failure.empty()) {
    throw InputError(failure + "; the fit starts there: start it from other values");
  }
  const bool at_kink = search_minimum(problem, options, state);
  const FitPoint& end = problem.linearize(state.weights.data());
  FitResult result =
      describe_fit(model, end.at, end.values, problem.list_held(state.weights.data()), at_kink);
  result.iterations = state.iterations;
  return result;
}

FitResult fit_simulation(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& unknowns,
                         const FitOptions& options) {
  return fit_readings(*make_readings(runs, unknowns, options.linearize), options);
}

Uncertainty calc_fit_bounds(const std::vector<MeasuredRun>& runs,
                            const std::vector<Unknown>& unknowns, const LinearizeOptions& options) {
  const auto model = make_readings(runs, unknowns, options);
  const Linearization at = model->linearize(list_starts(unknowns));
  if (!at.failure.empty()) throw InputError(at.failure);
  return calc_uncertainty(calc_normal_equations(*model, at).information, unknowns);
}

}  // namespace strut
