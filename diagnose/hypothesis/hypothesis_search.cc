#include "diagnose/hypothesis/hypothesis_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "estimate/fit.h"

namespace strut {
namespace {

using Index = Eigen::Index;

/// How a parameter of a hypothesis is counted.
struct Coordinate {
  double beginning = 0.0, unit = 1.0;
  double reference = 0.0;  // value without the hypothesis
  bool is_logarithm = false, is_shape = false;
  double low = 0.0, high = 0.0;

  double calc_value(double x) const {
    const double value = is_logarithm ? beginning * std::exp(x) : beginning + unit * x;
    return std::clamp(value, low, high);
  }
  double calc_coordinate(double value) const {
    return is_logarithm ? std::log(std::max(value, 1e-12) / beginning) : (value - beginning) / unit;
  }
};

std::vector<Coordinate> make_coordinates(const Hypothesis& h, const std::vector<Unknown>& unknowns,
                                         const std::vector<double>& beginning) {
  std::vector<Coordinate> coordinates;
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    Coordinate c;
    c.beginning = beginning[i];
    c.reference = h.reference[i];
    c.is_shape = !h.parameters[i].switches;
    c.is_logarithm = c.is_shape && beginning[i] > 0.0 && unknowns[i].low >= 0.0;
    const double size = std::abs(beginning[i] - h.reference[i]);
    c.unit = size > 0.0 && !c.is_shape ? size : 1.0;
    const bool is_pinned = h.change == EffectChange::kRemoved;
    c.low = is_pinned ? beginning[i] : unknowns[i].low;
    c.high = is_pinned ? beginning[i] : unknowns[i].high;
    coordinates.push_back(c);
  }
  return coordinates;
}

class Search {
 public:
  Search(const SearchGround& ground, ReadingModel& model, std::vector<Coordinate> coordinates)
      : ground_(ground),
        model_(model),
        coordinates_(std::move(coordinates)),
        profiles_(!ground.has_inputs && !ground.whitener.roads().empty()),
        n_(profiles_ ? 0 : static_cast<Index>(ground.values.size())),
        m_(static_cast<Index>(coordinates_.size())),
        x_(Eigen::VectorXd::Zero(n_ + m_)),
        low_(n_ + m_),
        high_(n_ + m_),
        center_(ground.values) {
    for (Index i = 0; i < n_; ++i) {
      const Unknown& u = ground.unknowns[static_cast<std::size_t>(i)];
      const double value = ground.values[static_cast<std::size_t>(i)];
      low_(i) = (u.low - value) / u.scale;
      high_(i) = (u.high - value) / u.scale;
    }
    for (Index j = 0; j < m_; ++j) {
      const Coordinate& c = get_coordinate(j);
      low_(n_ + j) = c.calc_coordinate(c.low);
      high_(n_ + j) = c.calc_coordinate(c.high);
    }
  }

  HypothesisFit run(const SearchEffort& effort, const std::vector<double>& from) {
    constexpr int kFollowed = 2;
    if (from.empty() ? begin() : resume(from)) approach(effort);
    for (int i = 0; i < kFollowed && follow(); ++i) approach(effort);
    fit_.simulations = model_.simulation_count();
    if (information_.size() > 0) conclude();
    return std::move(fit_);
  }

 private:
  const Coordinate& get_coordinate(Index j) const {
    return coordinates_[static_cast<std::size_t>(j)];
  }

  /// The model's values there.
  std::vector<double> get_point(const Eigen::VectorXd& at) const {
    std::vector<double> point;
    for (std::size_t i = 0; i < ground_.values.size(); ++i) {
      const Unknown& u = ground_.unknowns[i];
      const double change = profiles_ ? 0.0 : u.scale * at(static_cast<Index>(i));
      point.push_back(std::clamp(center_[i] + change, u.low, u.high));
    }
    for (Index j = 0; j < m_; ++j) point.push_back(get_coordinate(j).calc_value(at(n_ + j)));
    return point;
  }

  /// The residual's component orthogonal to the derivatives by the ground's unknowns.
  Eigen::VectorXd project(const Eigen::VectorXd& residual) const {
    return residual -
           ground_.jacobian * ground_.regular_normal.solve(ground_.jacobian.transpose() * residual);
  }

  Eigen::VectorXd reduce(const Eigen::VectorXd& residual) const {
    return profiles_ ? project(residual) : residual;
  }

  /// By how much the ground's unknowns, in their scale, follow what the search has changed; 0 at
  /// the ground, whose own distance to its minimum is not of the hypothesis.
  Eigen::VectorXd calc_followed() const {
    return -ground_.regular_normal.solve(ground_.jacobian.transpose() *
                                         (whole_ - ground_.residual));
  }

  /// Moves the ground's unknowns where they follow so far that they may not be linear; what the
  /// simulation says there counts, more or less than was extrapolated.
  bool follow() {
    constexpr double kFar = 3.0;  // standard deviations
    if (!profiles_ || residual_.size() == 0) return false;
    const Eigen::VectorXd change = calc_followed();
    if ((ground_.jacobian * change).norm() < kFar) return false;
    const std::vector<double> before = center_;
    for (std::size_t i = 0; i < center_.size(); ++i) {
      center_[i] += ground_.unknowns[i].scale * change(static_cast<Index>(i));
    }
    const Evaluation there = model_.evaluate(get_point(x_));
    if (!there.failure.empty()) {
      center_ = before;
      return false;
    }
    whole_ = ground_.whitener.apply_residual(there.residual);
    residual_ = project(whole_);
    chi2_ = residual_.squaredNorm() + calc_shape_chi2(x_);
    return true;
  }

  /// Of the prior of shapes.
  double calc_shape_chi2(const Eigen::VectorXd& at) const {
    double chi2 = 0.0;
    for (Index j = 0; j < m_; ++j) {
      if (get_coordinate(j).is_shape) chi2 += at(n_ + j) * at(n_ + j);
    }
    return chi2;
  }

  /// What is linear at first may not stay so: less of it may be a better beginning. A lost stroke
  /// that ends between two readings has valleys of its own, so a rig, being cheap, is asked often.
  bool begin() {
    struct Shares {
      double least, factor;
    };
    const Shares shares = ground_.has_inputs ? Shares{0.02, 0.7} : Shares{0.05, 0.4};
    std::vector<Eigen::VectorXd> tried;
    std::vector<std::vector<double>> points;
    for (double share = 1.0; share > 0.9 * shares.least; share *= shares.factor) {
      Eigen::VectorXd at = x_;
      for (Index j = 0; j < m_; ++j) {
        const Coordinate& c = get_coordinate(j);
        if (c.is_shape || c.low == c.high) continue;
        at(n_ + j) = (share - 1.0) * (c.beginning - c.reference) / c.unit;
      }
      if (!tried.empty() && tried.back() == at) break;  // no size to begin with
      points.push_back(get_point(at));
      tried.push_back(std::move(at));
    }
    const std::vector<Evaluation> there = model_.evaluate(points);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (!there[i].failure.empty()) continue;
      const Eigen::VectorXd residual = ground_.whitener.apply_residual(there[i].residual);
      const double chi2 = project(residual).squaredNorm();
      if (!(chi2 < least)) continue;
      least = chi2;
      x_ = tried[i];
      whole_ = residual;
    }
    if (whole_.size() == 0) {
      fit_.failure = "cannot be simulated";
      return false;
    }
    residual_ = reduce(whole_);
    chi2_ = residual_.squaredNorm() + calc_shape_chi2(x_);
    return true;
  }

  bool resume(const std::vector<double>& from) {
    const std::size_t base = ground_.values.size();
    if (profiles_) std::copy_n(from.begin(), base, center_.begin());
    for (Index i = 0; i < n_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      x_(i) = (from[at] - ground_.values[at]) / ground_.unknowns[at].scale;
    }
    for (Index j = 0; j < m_; ++j) {
      x_(n_ + j) = get_coordinate(j).calc_coordinate(from[base + static_cast<std::size_t>(j)]);
    }
    const Evaluation e = model_.evaluate(get_point(x_));
    fit_.failure = e.failure;
    if (!e.failure.empty()) return false;
    whole_ = ground_.whitener.apply_residual(e.residual);
    residual_ = reduce(whole_);
    chi2_ = residual_.squaredNorm() + calc_shape_chi2(x_);
    return true;
  }

  /// Steps until the minimum is near by derivatives of there, or no step leads down.
  void approach(const SearchEffort& effort) {
    constexpr double kEnough = 0.25;  // decrease over the predicted one: the derivatives serve on
    bool renew = true;
    fit_.converged = false;
    for (; steps_ < effort.steps; ++steps_) {
      if (renew && !linearize()) return;
      fit_.distance = calc_distance();
      if (fit_.distance <= effort.distance) {
        fit_.converged = is_fresh_ && fit_.distance <= kFitTolerance;
        if (is_fresh_) return;
        renew = true;
        continue;
      }
      const double ratio = improve();
      if (ratio == 0.0 && is_fresh_) {
        fit_.converged = fit_.distance <= kKinkTolerance;
        return;
      }
      renew = !is_corrected() || ratio < kEnough;
    }
  }

  /// Derivatives of whitened readings by the coordinates, by differences.
  Eigen::MatrixXd calc_differences() {
    constexpr double kSide = 0.02;
    std::vector<std::vector<double>> points;
    std::vector<double> widths;
    for (Index j = 0; j < m_; ++j) {
      const Coordinate& c = get_coordinate(j);
      double width = c.is_logarithm ? kSide : kSide * std::max(1.0, std::abs(x_(n_ + j)));
      // Away from a bound that holds it.
      if (c.calc_value(x_(n_ + j) + width) == c.calc_value(x_(n_ + j))) width = -width;
      Eigen::VectorXd aside = x_;
      aside(n_ + j) += width;
      points.push_back(get_point(aside));
      widths.push_back(width);
    }
    const std::vector<Evaluation> sides = model_.evaluate(points);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(residual_.size(), m_);
    for (Index j = 0; j < m_; ++j) {
      const auto at = static_cast<std::size_t>(j);
      if (!sides[at].failure.empty()) continue;
      columns.col(j) =
          (reduce(ground_.whitener.apply_residual(sides[at].residual)) - residual_) / widths[at];
    }
    return columns;
  }

  /// Derivatives where the search stands. False where a rig cannot be simulated beside it.
  bool linearize() {
    if (ground_.has_inputs) {
      // Strong effects change what the other parameters do.
      const std::vector<double> point = get_point(x_);
      const Linearization at = model_.linearize(point);
      if (!at.failure.empty()) {
        fit_.failure = at.failure;
        return false;
      }
      jacobian_ = ground_.whitener.apply(at.jacobian);
      for (Index j = 0; j < m_; ++j) {
        const Coordinate& c = get_coordinate(j);
        const auto i = static_cast<std::size_t>(n_ + j);
        jacobian_.col(n_ + j) *= (c.is_logarithm ? point[i] : c.unit) / model_.unknowns()[i].scale;
      }
      gather(jacobian_.leftCols(n_).transpose() * jacobian_.leftCols(n_));
    } else {
      jacobian_.resize(residual_.size(), n_ + m_);
      jacobian_.leftCols(n_) = ground_.jacobian.leftCols(n_);
      jacobian_.rightCols(m_) = calc_differences();
      gather(ground_.normal.topLeftCorner(n_, n_));
    }
    is_fresh_ = true;
    return true;
  }

  /// Normal equations; `normal`: those of the ground's unknowns.
  void gather(const Eigen::MatrixXd& normal) {
    const auto base = jacobian_.leftCols(n_), columns = jacobian_.rightCols(m_);
    information_.resize(n_ + m_, n_ + m_);
    information_.topLeftCorner(n_, n_) = normal;
    information_.topRightCorner(n_, m_).noalias() = base.transpose() * columns;
    information_.bottomLeftCorner(m_, n_) = information_.topRightCorner(n_, m_).transpose();
    information_.bottomRightCorner(m_, m_).noalias() = columns.transpose() * columns;
    for (Index j = 0; j < m_; ++j) {
      if (get_coordinate(j).is_shape) information_(n_ + j, n_ + j) += 1.0;
    }
    update_gradient();
  }

  void update_gradient() {
    gradient_.noalias() = jacobian_.transpose() * residual_;
    for (Index j = 0; j < m_; ++j) {
      if (get_coordinate(j).is_shape) gradient_(n_ + j) += x_(n_ + j);
    }
    system_ = information_;
    free_gradient_ = gradient_;
    for (Index i = 0; i < n_ + m_; ++i) {
      const bool is_held =
          (x_(i) <= low_(i) && gradient_(i) >= 0.0) || (x_(i) >= high_(i) && gradient_(i) <= 0.0);
      if (!is_held) continue;
      system_.row(i).setZero();
      system_.col(i).setZero();
      system_(i, i) = 1.0;
      free_gradient_(i) = 0.0;
    }
    system_.diagonal().array() += 1e-12;
  }

  double calc_distance() const {
    Eigen::MatrixXd regular = system_;
    regular.diagonal() *= 1.0 + 1e-10;
    const double rise = free_gradient_.dot(regular.ldlt().solve(free_gradient_));
    const double degrees = static_cast<double>(residual_.size() - ground_.jacobian.cols() - m_);
    const double misfit = std::max(1.0, chi2_ / std::max(1.0, degrees));
    return std::sqrt(std::max(0.0, rise) / misfit);
  }

  Eigen::VectorXd calc_step(double damping) const {
    Eigen::MatrixXd damped = system_;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd change = -damped.ldlt().solve(free_gradient_);
    return (x_ + change).cwiseMax(low_).cwiseMin(high_) - x_;
  }

  /// Takes the best of some steps of growing damping that leads down. A rig's share the lanes of
  /// one simulation. Returns its decrease of chi2 over the predicted one; 0: none leads down.
  double improve() {
    const int at_once = ground_.has_inputs ? 8 : 1;
    // The first damping that changes the step of a few parameters at all is about 1.
    const int attempts = ground_.has_inputs ? 2 : profiles_ ? 4 : 12;
    const double min_damping = profiles_ ? 1.0 : 1e-3;
    for (int attempt = 0; attempt < attempts; ++attempt) {
      std::vector<Eigen::VectorXd> steps;
      std::vector<std::vector<double>> points;
      std::vector<double> dampings;
      for (int k = 0; k < at_once; ++k) {
        Eigen::VectorXd step = calc_step(damping_);
        dampings.push_back(damping_);
        damping_ = std::max(min_damping, 10.0 * damping_);
        if (!step.allFinite()) continue;
        points.push_back(get_point(x_ + step));
        steps.push_back(std::move(step));
      }
      const double ratio = take_best(steps, dampings, model_.evaluate(points));
      if (ratio > 0.0) return ratio;
    }
    damping_ = 1e-6;
    return 0.0;
  }

  double take_best(const std::vector<Eigen::VectorXd>& steps, const std::vector<double>& dampings,
                   const std::vector<Evaluation>& there) {
    std::size_t best = steps.size();
    double least = chi2_;
    Eigen::VectorXd residual;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!there[i].failure.empty()) continue;
      const Eigen::VectorXd whole = ground_.whitener.apply_residual(there[i].residual);
      Eigen::VectorXd left = reduce(whole);
      const double chi2 = left.squaredNorm() + calc_shape_chi2(x_ + steps[i]);
      if (!(chi2 < least)) continue;
      best = i;
      least = chi2;
      residual = std::move(left);
      whole_ = whole;
    }
    if (best == steps.size()) return 0.0;
    const Eigen::VectorXd& step = steps[best];
    const double predicted = -2.0 * gradient_.dot(step) - step.dot(information_ * step);
    const double ratio = (chi2_ - least) / std::max(predicted, 1e-300);
    damping_ = std::max(1e-6, 0.01 * dampings[best]);
    if (is_corrected()) correct_jacobian(step, residual);
    x_ += step;
    residual_ = std::move(residual);
    chi2_ = least;
    update_gradient();
    return ratio;
  }

  /// Whether steps correct the derivatives: of all unknowns, or of the hypothesis alone.
  bool is_corrected() const { return ground_.has_inputs || profiles_; }

  /// Broyden's update: derivatives along the step become its difference.
  void correct_jacobian(const Eigen::VectorXd& step, const Eigen::VectorXd& residual) {
    // In the metric of the unknowns' standard errors, or a weakly determined one would take all.
    const Eigen::VectorXd weighted = information_.diagonal().cwiseMax(0.0).cwiseProduct(step);
    const double length = weighted.dot(step);
    if (!(length > 0.0)) return;
    const Eigen::VectorXd error = residual - residual_ - jacobian_ * step;
    const Eigen::VectorXd u = jacobian_.transpose() * error / length;
    information_ += u * weighted.transpose() + weighted * u.transpose() +
                    (error.squaredNorm() / (length * length)) * weighted * weighted.transpose();
    jacobian_ += error / length * weighted.transpose();
    is_fresh_ = false;
  }

  void conclude() {
    fit_.failure.clear();
    fit_.values = get_point(x_);
    if (profiles_) {
      const Eigen::VectorXd change = calc_followed();
      for (std::size_t i = 0; i < center_.size(); ++i) {
        const Unknown& u = ground_.unknowns[i];
        const double value = fit_.values[i] + u.scale * change(static_cast<Index>(i));
        fit_.values[i] = std::clamp(value, u.low, u.high);
      }
    }
    fit_.gain = reduce(ground_.residual).squaredNorm() - chi2_;
    Eigen::MatrixXd regular = information_;
    regular.diagonal().array() += 1e-12;
    const Eigen::MatrixXd covariance =
        regular.ldlt().solve(Eigen::MatrixXd::Identity(n_ + m_, n_ + m_));
    for (Index j = 0; j < m_; ++j) {
      const Coordinate& c = get_coordinate(j);
      const double sigma =
          c.low == c.high ? 0.0 : std::sqrt(std::max(0.0, covariance(n_ + j, n_ + j)));
      const double value = fit_.values[static_cast<std::size_t>(n_ + j)];
      fit_.sigma.push_back(c.is_logarithm ? sigma * value : sigma * c.unit);
    }
  }

  const SearchGround& ground_;
  ReadingModel& model_;
  const std::vector<Coordinate> coordinates_;
  /// On a road that was found, events that pass a reading make chi2 uneven by more than many a
  /// hypothesis gains. There the search moves the hypothesis alone, and compares what linear
  /// changes of the ground's unknowns leave.
  const bool profiles_;
  const Index n_, m_;  // coordinates of the ground's unknowns, 0 if it profiles; of the hypothesis
  Eigen::VectorXd x_;  // changes of the ground's unknowns in their scale, then coordinates
  Eigen::VectorXd low_, high_;
  std::vector<double> center_;        // values of the ground's unknowns at x_ = 0
  Eigen::VectorXd whole_, residual_;  // there; and reduced
  double chi2_ = 0.0, damping_ = 1e-6;
  int steps_ = 0;
  Eigen::MatrixXd jacobian_, information_;
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd system_;         // information without what bounds hold
  Eigen::VectorXd free_gradient_;  // likewise
  bool is_fresh_ = false;          // derivatives by differences at x_
  HypothesisFit fit_;
};

}  // namespace

HypothesisFit search_hypothesis(const SearchGround& ground, ReadingModel& model,
                                const Hypothesis& hypothesis, const std::vector<Unknown>& own,
                                const std::vector<double>& beginning, const SearchEffort& effort,
                                const std::vector<double>& from) {
  return Search(ground, model, make_coordinates(hypothesis, own, beginning)).run(effort, from);
}

}  // namespace strut
