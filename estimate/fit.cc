#include "estimate/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error/input_error.h"
#include "base/least_squares/levenberg_marquardt.h"
#include "estimate/fisher.h"

namespace strut {
namespace {

/// Weights are (value - start) / scale. Beyond a bound the value stays on it.
class FitProblem : public LeastSquaresProblem {
 public:
  explicit FitProblem(ReadingModel& simulator) : simulator_(simulator) {}

  std::size_t weight_count() const override { return simulator_.unknowns().size(); }
  double residual_count() const override {
    return static_cast<double>(simulator_.reading_count() + simulator_.prior_count());
  }

  double calc_gram(const double* weights, int /*epoch*/, double* h, double* gradient) override {
    const auto n = static_cast<Eigen::Index>(weight_count());
    const Linearization& at = linearize(weights);
    if (!at.failure.empty()) return std::numeric_limits<double>::infinity();
    const NormalEquations normal = free_unknowns(normal_, list_beyond(weights));
    Eigen::Map<Eigen::MatrixXd>(h, n, n) = normal.information;
    Eigen::Map<Eigen::VectorXd>(gradient, n) = normal.gradient;
    return at.residual.squaredNorm();
  }

  /// Where there is no simulation, or none beside it, the loss is infinite: a step that is not
  /// taken. Trial points are linearized at once: most are accepted, and then their Jacobian is
  /// there.
  double calc_loss(const double* weights) override {
    const Linearization& at = linearize(weights);
    return at.failure.empty() ? at.residual.squaredNorm() : std::numeric_limits<double>::infinity();
  }

  const Linearization& linearize(const double* weights) {
    const std::vector<double> values = calc_values(weights);
    if (values != last_values_) {
      last_ = simulator_.linearize(values);
      last_values_ = values;
      if (last_.failure.empty()) normal_ = calc_normal_equations(simulator_, last_);
    }
    return last_;
  }

  std::vector<double> calc_values(const double* weights) const {
    std::vector<double> values;
    values.reserve(weight_count());
    for (std::size_t i = 0; i < weight_count(); ++i) {
      const Unknown& u = simulator_.unknowns()[i];
      values.push_back(std::clamp(u.start + weights[i] * u.scale, u.low, u.high));
    }
    return values;
  }

  bool is_beyond(const double* weights, std::size_t i) const {
    const Unknown& u = simulator_.unknowns()[i];
    const double value = u.start + weights[i] * u.scale;
    return value < u.low || value > u.high;
  }

  double calc_distance(const double* weights) {
    const Linearization& at = linearize(weights);
    if (!at.failure.empty()) return std::numeric_limits<double>::infinity();
    return strut::calc_distance(free_unknowns(normal_, list_beyond(weights)));
  }

  double calc_widening(const double* weights) {
    const Linearization& at = linearize(weights);
    return at.failure.empty() ? strut::calc_widening(simulator_, at) : 1.0;
  }

  std::vector<bool> list_beyond(const double* weights) const {
    std::vector<bool> beyond;
    beyond.reserve(weight_count());
    for (std::size_t i = 0; i < weight_count(); ++i) beyond.push_back(is_beyond(weights, i));
    return beyond;
  }

  /// Brings weights beyond a bound back to it; returns whether the slope would lead inwards from
  /// one.
  bool release(std::vector<double>& weights) {
    const Linearization& at = linearize(weights.data());
    if (!at.failure.empty()) return false;
    const Eigen::VectorXd& gradient = normal_.gradient;
    bool inwards = false;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (!is_beyond(weights.data(), i)) continue;
      const Unknown& u = simulator_.unknowns()[i];
      const bool above = u.start + weights[i] * u.scale > u.high;
      const double slope = gradient(static_cast<Eigen::Index>(i));
      if ((above && slope <= 0.0) || (!above && slope >= 0.0)) continue;
      weights[i] = ((above ? u.high : u.low) - u.start) / u.scale * (1.0 - 1e-12);
      inwards = true;
    }
    return inwards;
  }

 private:
  ReadingModel& simulator_;
  std::vector<double> last_values_;
  Linearization last_;
  NormalEquations normal_;  // of last_
};

/// Weights where the search begins: the unknowns' own start, the measuring clocks set.
std::vector<double> make_start(ReadingModel& simulator, const FitOptions& options) {
  std::vector<double> weights =
      simulator.align(options.start.empty() ? list_starts(simulator.unknowns()) : options.start);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Unknown& u = simulator.unknowns()[i];
    weights[i] = (weights[i] - u.start) / u.scale;
  }
  return weights;
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

/// Steps until the minimum is within `near` standard deviations (`widened`: of those that what the
/// model leaves widens); false where no damping helps any
/// more.
bool approach(FitProblem& problem, const FitOptions& options, double near, bool widened,
              double max_damping, std::vector<double>& weights, int& iterations) {
  LevenbergMarquardt search(
      problem, nullptr,
      make_search_options(options.iterations - iterations, options.first_damping, max_damping));
  search.start(weights);
  const auto is_far = [&] {
    const double* at = search.state().weights.data();
    return problem.calc_distance(at) > near * (widened ? problem.calc_widening(at) : 1.0);
  };
  while (is_far() && search.step()) {
  }
  weights = search.state().weights;
  iterations += search.state().epoch;
  return search.state().stop != StopReason::kDamping;
}

/// Approaches the minimum; near it no longer insists: there the loss has kinks, where a contact
/// event passes a reading, and the linear model's last hundredths of a standard deviation may not
/// be there.
std::vector<double> search(FitProblem& problem, const FitOptions& options,
                           std::vector<double> weights, FitResult& result) {
  constexpr int kReleases = 3;
  constexpr double kNear = 0.01 * kFitTolerance, kPatience = 1e6, kNoPatience = 1e-3;
  for (int pass = 0; pass <= kReleases; ++pass) {
    int& iterations = result.iterations;
    result.at_kink =
        !approach(problem, options, kFitTolerance, true, kPatience, weights, iterations);
    approach(problem, options, kNear, false, kNoPatience, weights, iterations);
    if (!problem.release(weights)) break;
  }
  return weights;
}

std::vector<ChannelFit> judge_channels(const ReadingModel& simulator,
                                       const Eigen::VectorXd& residual) {
  std::vector<ChannelFit> fits;
  for (std::size_t r = 0; r < simulator.channels().size(); ++r) {
    const std::vector<int>& channels = simulator.channels()[r];
    for (std::size_t c = 0; c < channels.size(); ++c) {
      ChannelFit fit{static_cast<int>(r), channels[c]};
      double last = 0.0, products = 0.0;
      for (std::size_t k = 0; k < simulator.reading_count(); ++k) {
        const ReadingPlace& place = simulator.readings()[k];
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

Uncertainty calc_widened(const NormalEquations& normal, const FitResult& result) {
  const double misfit = std::max(1.0, result.chi2_per_degree());
  Eigen::MatrixXd priors = normal.of_priors;
  // The prior of a map is in units of the residual (map_prior.h).
  for (std::size_t i = 0; i < result.unknowns.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (result.unknowns[i].kind == UnknownKind::kForceMap) priors(at, at) /= misfit;
  }
  return calc_uncertainty((normal.information - normal.of_priors) / misfit + priors,
                          result.unknowns);
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
  const double degrees = static_cast<double>(model.reading_count() + model.prior_count()) -
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
  result.degrees =
      static_cast<long>(model.reading_count() + model.prior_count()) - result.uncertainty.rank;
  result.widened = calc_widened(normal, result);
  result.channels = judge_channels(model, at.residual);
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
  const std::vector<double> start = make_start(model, options);
  const std::string failure = problem.linearize(start.data()).failure;
  if (!failure.empty()) throw InputError(failure + "; the fit starts there: start it elsewhere");
  FitResult ended;
  const std::vector<double> weights = search(problem, options, start, ended);
  FitResult result =
      describe_fit(model, problem.linearize(weights.data()), problem.calc_values(weights.data()),
                   problem.list_beyond(weights.data()), ended.at_kink);
  result.iterations = ended.iterations;
  return result;
}

FitResult fit_simulation(const std::vector<MeasuredRun>& runs, const std::vector<Unknown>& unknowns,
                         const FitOptions& options) {
  ReadingSimulator simulator(runs, unknowns, options.linearize);
  return fit_readings(simulator, options);
}

Uncertainty calc_fit_bounds(const std::vector<MeasuredRun>& runs,
                            const std::vector<Unknown>& unknowns, const LinearizeOptions& options) {
  ReadingSimulator simulator(runs, unknowns, options);
  const Linearization at = simulator.linearize(list_starts(unknowns));
  if (!at.failure.empty()) throw InputError(at.failure);
  return calc_uncertainty(calc_normal_equations(simulator, at).information, unknowns);
}

}  // namespace strut
