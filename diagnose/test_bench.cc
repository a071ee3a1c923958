#include "diagnose/test_bench.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io/input_error.h"

namespace strut {
namespace {

using Index = Eigen::Index;

Index as_index(std::size_t i) { return static_cast<Index>(i); }

/// Products less what `count` of the unknowns from `begin` on can take (their Schur complement).
Eigen::MatrixXd eliminate(const Eigen::MatrixXd& products, Index begin, Index count) {
  const Index rest = products.rows() - begin - count;
  Eigen::MatrixXd kept(begin + rest, begin + rest), mixed(count, begin + rest);
  kept.topLeftCorner(begin, begin) = products.topLeftCorner(begin, begin);
  kept.topRightCorner(begin, rest) = products.topRightCorner(begin, rest);
  kept.bottomLeftCorner(rest, begin) = products.bottomLeftCorner(rest, begin);
  kept.bottomRightCorner(rest, rest) = products.bottomRightCorner(rest, rest);
  if (count == 0) return kept;
  mixed.leftCols(begin) = products.block(begin, 0, count, begin);
  mixed.rightCols(rest) = products.block(begin, begin + count, count, rest);
  const Eigen::MatrixXd own = products.block(begin, begin, count, count);
  // Unknowns of which the readings say nothing leave zeros.
  Eigen::LDLT<Eigen::MatrixXd> factor(own + 1e-12 * own.diagonal().maxCoeff() *
                                                Eigen::MatrixXd::Identity(count, count));
  kept.noalias() -= mixed.transpose() * factor.solve(mixed);
  return kept;
}

/// How a parameter of a hypothesis is counted in a fit: sizes as multiples of their beginning,
/// shapes by their logarithm where they are positive, as no shape is known but to a factor.
struct Coordinate {
  double beginning = 0.0, unit = 1.0;
  bool is_logarithm = false, is_shape = false;
  double low = 0.0, high = 0.0;

  /// Within the bounds, so that a step back leads back.
  double restrain(double x) const {
    if (is_logarithm) {
      return std::clamp(x, std::log(std::max(low, 1e-12) / beginning), std::log(high / beginning));
    }
    return std::clamp(x, (low - beginning) / unit, (high - beginning) / unit);
  }

  double calc_value(double x) const {
    const double value = is_logarithm ? beginning * std::exp(x) : beginning + unit * x;
    return std::clamp(value, low, high);
  }
};

std::vector<Coordinate> make_coordinates(const Hypothesis& h, const std::vector<Unknown>& unknowns,
                                         const std::vector<double>& beginning) {
  std::vector<Coordinate> coordinates;
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    Coordinate c;
    c.beginning = beginning[i];
    c.is_shape = !h.parameters[i].switches;
    c.is_logarithm = c.is_shape && beginning[i] > 0.0 && unknowns[i].low >= 0.0;
    c.unit = beginning[i] != 0.0 && !c.is_shape ? std::abs(beginning[i]) : 1.0;
    c.low = unknowns[i].low;
    c.high = unknowns[i].high;
    coordinates.push_back(c);
  }
  return coordinates;
}

}  // namespace

TestBench::TestBench(const CampaignData& data, const WhitenedFit& fit, int threads)
    : data_(data),
      runs_(fit.runs),
      unknowns_(fit.fit.unknowns),
      values_(fit.fit.values),
      shared_count_(fit.shared_count),
      threads_(threads) {
  const auto model = make_reading_model(data_, runs_, unknowns_, threads_);
  whitener_ = std::make_unique<Whitener>(*model, fit.spectra);
  const WhitenedModel whitened(*model, *whitener_);
  std::shared_ptr<const Linearization> given = fit.linearization;
  if (!given) given = std::make_shared<const Linearization>(model->linearize(values_));
  if (!given->failure.empty()) throw InputError(given->failure);
  Linearization at = whitener_->apply(*given);
  normal_ = calc_normal_equations(whitened, at).information;
  residual_ = std::move(at.residual);
  jacobian_ = std::move(at.jacobian);
  Eigen::MatrixXd regular = normal_;
  regular.diagonal().array() *= 1.0 + 1e-12;
  regular.diagonal().array() += 1e-12;
  regular_normal_.compute(regular);
  simulations_ += model->simulation_count();
}

std::unique_ptr<ReadingModel> TestBench::make_model(const std::vector<Unknown>& added,
                                                    int threads) const {
  std::vector<Unknown> all = unknowns_;
  all.insert(all.end(), added.begin(), added.end());
  return make_reading_model(data_, runs_, std::move(all), threads);
}

Eigen::MatrixXd TestBench::simulate_columns(const std::vector<Unknown>& added,
                                            const std::vector<std::vector<double>>& points) {
  const auto model = make_model(added, threads_);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(residual_.size(), as_index(points.size()));
  constexpr std::size_t kAtOnce = 64;
  for (std::size_t begin = 0; begin < points.size(); begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, points.size());
    std::vector<std::vector<double>> all(end - begin, values_);
    for (std::size_t i = begin; i < end; ++i) {
      all[i - begin].insert(all[i - begin].end(), points[i].begin(), points[i].end());
    }
    const std::vector<Evaluation> evaluations = model->evaluate(all);
    for (std::size_t i = begin; i < end; ++i) {
      const Evaluation& e = evaluations[i - begin];
      if (!e.failure.empty()) continue;  // no such size: a column of zeros is no hypothesis
      columns.col(as_index(i)) = whitener_->apply(e.residual) - residual_;
    }
  }
  simulations_ += model->simulation_count();
  return columns;
}

Eigen::MatrixXd TestBench::simulate_columns(const std::vector<Hypothesis>& hypotheses,
                                            std::vector<HypothesisTrial>& trials) {
  std::vector<Unknown> added;
  for (const Hypothesis& h : hypotheses) {
    for (Unknown& u : make_unknowns(data_, h)) added.push_back(std::move(u));
  }
  const std::vector<double> neutral = list_starts(added);
  std::vector<std::vector<double>> points;
  std::size_t first = 0;
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const Hypothesis& hypothesis = hypotheses[h];
    for (std::size_t b = 0; b < hypothesis.beginnings.size(); ++b) {
      HypothesisTrial trial{h, b, {}, {}};
      for (std::size_t j = 0; j < hypothesis.parameters.size(); ++j) {
        if (!hypothesis.parameters[j].switches) continue;
        std::vector<double> point = neutral;
        for (std::size_t i = 0; i < hypothesis.parameters.size(); ++i) {
          const bool set = i == j || !hypothesis.parameters[i].switches;
          if (set) point[first + i] = hypothesis.beginnings[b][i];
        }
        trial.columns.push_back(points.size());
        trial.parameters.push_back(j);
        points.push_back(std::move(point));
      }
      trials.push_back(std::move(trial));
    }
    first += hypothesis.parameters.size();
  }
  return simulate_columns(added, points);
}

Evidence TestBench::gather(const std::vector<Hypothesis>& hypotheses) {
  Evidence evidence;
  evidence.shared = shared_count_;
  const Eigen::MatrixXd columns = simulate_columns(hypotheses, evidence.trials);
  const auto rows = residual_.size();
  // By run: the shared unknowns, its own, the columns, the residual.
  const auto shared = as_index(shared_count_), count = columns.cols();
  const auto add_products = [&](Index begin, Index length, const std::vector<Index>& own) {
    const auto width = shared + as_index(own.size()) + count + 1;
    Eigen::MatrixXd all(length, width);
    all.leftCols(shared) = jacobian_.block(begin, 0, length, shared);
    for (std::size_t i = 0; i < own.size(); ++i) {
      all.col(shared + as_index(i)) = jacobian_.col(own[i]).segment(begin, length);
    }
    all.middleCols(shared + as_index(own.size()), count) = columns.middleRows(begin, length);
    all.col(width - 1) = residual_.segment(begin, length);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(width, width);
    products.selfadjointView<Eigen::Lower>().rankUpdate(all.transpose());
    products = products.selfadjointView<Eigen::Lower>();
    return products;
  };
  const auto whitened = as_index(whitener_->whitened_count());
  std::vector<Index> all_own;
  for (Index i = shared; i < jacobian_.cols(); ++i) all_own.push_back(i);
  // Priors of a run's own unknowns belong to the run.
  Eigen::MatrixXd priors = add_products(whitened, rows - whitened, all_own);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    std::vector<Index> own;
    for (std::size_t i = shared_count_; i < unknowns_.size(); ++i) {
      if (unknowns_[i].run == static_cast<int>(r)) own.push_back(as_index(i));
    }
    const auto begin = as_index(whitener_->run_begin()[r]);
    const auto length = as_index(whitener_->run_begin()[r + 1]) - begin;
    Eigen::MatrixXd products = add_products(begin, length, own);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Index at = shared + as_index(i);
      products(at, at) += priors(own[i], own[i]);
      const Index last = priors.rows() - 1;
      products(at, products.cols() - 1) += priors(own[i], last);
      products(products.rows() - 1, at) += priors(last, own[i]);
    }
    evidence.products.push_back(eliminate(products, shared, as_index(own.size())));
  }
  // What is left of the priors: those of shared unknowns.
  Eigen::MatrixXd of_shared = Eigen::MatrixXd::Zero(shared + count + 1, shared + count + 1);
  of_shared.topLeftCorner(shared, shared) = priors.topLeftCorner(shared, shared);
  of_shared.topRightCorner(shared, 1) = priors.topRightCorner(shared, 1);
  of_shared.bottomLeftCorner(1, shared) = priors.bottomLeftCorner(1, shared);
  evidence.products.push_back(of_shared);
  return evidence;
}

namespace {

/// Derivatives by the coordinates of a hypothesis, of whitened readings, by differences.
template <class GetPoint>
Eigen::MatrixXd calc_differences(ReadingModel& model, const Whitener& whitener,
                                 const Eigen::VectorXd& x, const Eigen::VectorXd& residual,
                                 const std::vector<Coordinate>& coordinates,
                                 const GetPoint& get_point) {
  constexpr double kSide = 0.02;
  const auto m = static_cast<Index>(coordinates.size()), n = x.size() - m;
  std::vector<std::vector<double>> points;
  std::vector<double> widths;
  for (Index j = 0; j < m; ++j) {
    const Coordinate& c = coordinates[static_cast<std::size_t>(j)];
    double width = c.is_logarithm ? kSide : kSide * std::max(1.0, std::abs(x(n + j)));
    // Away from a bound that holds it.
    if (c.calc_value(x(n + j) + width) == c.calc_value(x(n + j))) width = -width;
    Eigen::VectorXd aside = x;
    aside(n + j) += width;
    points.push_back(get_point(aside));
    widths.push_back(width);
  }
  const std::vector<Evaluation> sides = model.evaluate(points);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(residual.size(), m);
  for (Index j = 0; j < m; ++j) {
    const Evaluation& e = sides[static_cast<std::size_t>(j)];
    if (!e.failure.empty()) continue;
    columns.col(j) = (whitener.apply(e.residual) - residual) / widths[static_cast<std::size_t>(j)];
  }
  return columns;
}

}  // namespace

HypothesisFit TestBench::fit(const Hypothesis& hypothesis,
                             const std::vector<double>& beginning) const {
  const int steps = data_.is_rig() ? 60 : 12;
  constexpr double kEnough = 0.02, kEnoughShare = 1e-5;  // of chi2
  const auto model = make_model(make_unknowns(data_, hypothesis), 1);
  const std::vector<Coordinate> coordinates =
      make_coordinates(hypothesis, make_unknowns(data_, hypothesis), beginning);
  const std::size_t base = values_.size(), own = coordinates.size();
  const auto n = as_index(base), m = as_index(own);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + m);
  const auto get_point = [&](const Eigen::VectorXd& at) {
    std::vector<double> point;
    for (std::size_t i = 0; i < base; ++i) {
      const Unknown& u = unknowns_[i];
      point.push_back(std::clamp(values_[i] + u.scale * at(as_index(i)), u.low, u.high));
    }
    for (std::size_t i = 0; i < own; ++i) {
      point.push_back(coordinates[i].calc_value(at(as_index(base + i))));
    }
    return point;
  };
  const auto calc_shape_chi2 = [&](const Eigen::VectorXd& at) {
    double chi2 = 0.0;
    for (std::size_t i = 0; i < own; ++i) {
      if (coordinates[i].is_shape) chi2 += at(n + as_index(i)) * at(n + as_index(i));
    }
    return chi2;
  };
  HypothesisFit fit;
  const auto evaluate = [&](const Eigen::VectorXd& at, Eigen::VectorXd& residual) {
    const Evaluation e = model->evaluate(get_point(at));
    if (!e.failure.empty()) return false;
    residual = whitener_->apply(e.residual);
    return true;
  };
  // What is linear at first may not stay so: less of it may be a better beginning.
  Eigen::VectorXd residual;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : {1.0, 0.4, 0.15, 0.05}) {
    Eigen::VectorXd tried = x;
    for (Index j = 0; j < m; ++j) {
      const Coordinate& c = coordinates[static_cast<std::size_t>(j)];
      if (!c.is_shape && c.beginning != 0.0) tried(n + j) = (share - 1.0) * c.beginning / c.unit;
    }
    Eigen::VectorXd there;
    if (!evaluate(tried, there)) continue;
    const Eigen::VectorXd slope = jacobian_.transpose() * there;
    const double chi2 = there.squaredNorm() - slope.dot(regular_normal_.solve(slope));
    if (chi2 >= least) continue;
    least = chi2;
    x = tried;
    residual = there;
  }
  if (residual.size() == 0) {
    fit.failure = "cannot be simulated";
    fit.simulations = model->simulation_count();
    return fit;
  }
  double chi2 = residual.squaredNorm() + calc_shape_chi2(x), damping = 1e-6;
  Eigen::MatrixXd information;
  for (int step = 0; step < steps; ++step) {
    Eigen::MatrixXd columns, base_columns;
    if (data_.is_rig()) {
      // Cheap, and strong effects change what the other parameters do.
      const std::vector<double> point = get_point(x);
      const Linearization at = model->linearize(point);
      if (!at.failure.empty()) {
        fit.failure = at.failure;
        break;
      }
      const Eigen::MatrixXd jacobian = whitener_->apply(at.jacobian);
      base_columns = jacobian.leftCols(n);
      columns = jacobian.rightCols(m);
      for (Index j = 0; j < m; ++j) {
        const Coordinate& c = coordinates[static_cast<std::size_t>(j)];
        const auto i = static_cast<std::size_t>(n + j);
        columns.col(j) *= (c.is_logarithm ? point[i] : c.unit) / model->unknowns()[i].scale;
      }
    } else {
      columns = calc_differences(*model, *whitener_, x, residual, coordinates, get_point);
    }
    const Eigen::MatrixXd& base_jacobian = data_.is_rig() ? base_columns : jacobian_;
    information.resize(n + m, n + m);
    information.topLeftCorner(n, n) =
        data_.is_rig() ? Eigen::MatrixXd(base_columns.transpose() * base_columns) : normal_;
    information.topRightCorner(n, m).noalias() = base_jacobian.transpose() * columns;
    information.bottomLeftCorner(m, n) = information.topRightCorner(n, m).transpose();
    information.bottomRightCorner(m, m).noalias() = columns.transpose() * columns;
    Eigen::VectorXd gradient(n + m);
    gradient.head(n).noalias() = base_jacobian.transpose() * residual;
    gradient.tail(m).noalias() = columns.transpose() * residual;
    for (std::size_t i = 0; i < own; ++i) {
      if (!coordinates[i].is_shape) continue;
      information(n + as_index(i), n + as_index(i)) += 1.0;
      gradient(n + as_index(i)) += x(n + as_index(i));
    }
    bool improved = false, done = false;
    for (int attempt = 0; attempt < 12 && !improved; ++attempt) {
      Eigen::MatrixXd damped = information;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-12;
      const Eigen::VectorXd change = -damped.ldlt().solve(gradient);
      const double expected = -gradient.dot(change) * 2.0 - change.dot(information * change);
      if (expected < std::max(kEnough, kEnoughShare * chi2)) {
        done = true;
        break;
      }
      Eigen::VectorXd tried = x + change;
      for (Index j = 0; j < m; ++j) {
        tried(n + j) = coordinates[static_cast<std::size_t>(j)].restrain(tried(n + j));
      }
      Eigen::VectorXd next;
      if (change.allFinite() && evaluate(tried, next)) {
        const double less = next.squaredNorm() + calc_shape_chi2(tried);
        if (less < chi2) {
          done = chi2 - less < std::max(kEnough, 0.1 * kEnoughShare * chi2);
          x = tried;
          residual = next;
          chi2 = less;
          improved = true;
          damping = std::max(1e-6, 0.1 * damping);
          continue;
        }
      }
      damping = std::max(1e-3, 10.0 * damping);
    }
    if (done || !improved) break;
  }
  fit.simulations = model->simulation_count();
  if (information.size() == 0) return fit;  // not one step could be made
  fit.failure.clear();
  // A coordinate that was carried beyond its bound stays on it.
  fit.values = get_point(x);
  fit.gain = residual_.squaredNorm() - chi2;
  Eigen::MatrixXd regular = information;
  regular.diagonal().array() += 1e-12;
  const Eigen::MatrixXd covariance = regular.ldlt().solve(Eigen::MatrixXd::Identity(n + m, n + m));
  for (std::size_t i = 0; i < own; ++i) {
    const double sigma = std::sqrt(std::max(0.0, covariance(n + as_index(i), n + as_index(i))));
    const Coordinate& c = coordinates[i];
    fit.sigma.push_back(c.is_logarithm ? sigma * fit.values[base + i] : sigma * c.unit);
  }
  return fit;
}

}  // namespace strut
