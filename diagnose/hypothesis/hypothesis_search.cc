#include "diagnose/hypothesis/hypothesis_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace strut {
namespace {

using Index = Eigen::Index;

constexpr double kEnough = 0.02, kEnoughShare = 1e-5;  // of chi2

/// How a parameter of a hypothesis is counted.
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

class Search {
 public:
  Search(const SearchGround& ground, ReadingModel& model, std::vector<Coordinate> coordinates)
      : ground_(ground),
        model_(model),
        coordinates_(std::move(coordinates)),
        n_(static_cast<Index>(ground.values.size())),
        m_(static_cast<Index>(coordinates_.size())),
        x_(Eigen::VectorXd::Zero(n_ + m_)) {}

  HypothesisFit run() {
    const int steps = ground_.has_inputs ? 60 : 12;
    if (begin()) {
      for (int step = 0; step < steps && linearize() && improve(); ++step) {
      }
    }
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
      const double value = ground_.values[i] + u.scale * at(static_cast<Index>(i));
      point.push_back(std::clamp(value, u.low, u.high));
    }
    for (Index j = 0; j < m_; ++j) point.push_back(get_coordinate(j).calc_value(at(n_ + j)));
    return point;
  }

  /// Of the prior of shapes.
  double calc_shape_chi2(const Eigen::VectorXd& at) const {
    double chi2 = 0.0;
    for (Index j = 0; j < m_; ++j) {
      if (get_coordinate(j).is_shape) chi2 += at(n_ + j) * at(n_ + j);
    }
    return chi2;
  }

  bool evaluate(const Eigen::VectorXd& at, Eigen::VectorXd& residual) {
    const Evaluation e = model_.evaluate(get_point(at));
    if (!e.failure.empty()) return false;
    residual = ground_.whitener.apply(e.residual);
    return true;
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
      if (!tried.empty() && tried.back() == x_) break;  // no size to begin with
      tried.push_back(x_);
      for (Index j = 0; j < m_; ++j) {
        const Coordinate& c = get_coordinate(j);
        if (c.is_shape || c.beginning == 0.0) continue;
        tried.back()(n_ + j) = (share - 1.0) * c.beginning / c.unit;
      }
      points.push_back(get_point(tried.back()));
    }
    const std::vector<Evaluation> there = model_.evaluate(points);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (!there[i].failure.empty()) continue;
      const Eigen::VectorXd residual = ground_.whitener.apply(there[i].residual);
      const Eigen::VectorXd slope = ground_.jacobian.transpose() * residual;
      const double chi2 = residual.squaredNorm() - slope.dot(ground_.regular_normal.solve(slope));
      if (chi2 >= least) continue;
      least = chi2;
      x_ = tried[i];
      residual_ = residual;
    }
    if (residual_.size() == 0) {
      fit_.failure = "cannot be simulated";
      return false;
    }
    chi2_ = residual_.squaredNorm() + calc_shape_chi2(x_);
    return true;
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
      columns.col(j) = (ground_.whitener.apply(sides[at].residual) - residual_) / widths[at];
    }
    return columns;
  }

  /// Normal equations where the search stands. False where a rig cannot be simulated beside it.
  bool linearize() {
    if (!ground_.has_inputs) {
      gather(ground_.jacobian, ground_.normal, calc_differences());
      return true;
    }
    // Cheap, and strong effects change what the other parameters do.
    const std::vector<double> point = get_point(x_);
    const Linearization at = model_.linearize(point);
    if (!at.failure.empty()) {
      fit_.failure = at.failure;
      return false;
    }
    const Eigen::MatrixXd jacobian = ground_.whitener.apply(at.jacobian);
    Eigen::MatrixXd columns = jacobian.rightCols(m_);
    for (Index j = 0; j < m_; ++j) {
      const Coordinate& c = get_coordinate(j);
      const auto i = static_cast<std::size_t>(n_ + j);
      columns.col(j) *= (c.is_logarithm ? point[i] : c.unit) / model_.unknowns()[i].scale;
    }
    const Eigen::MatrixXd base = jacobian.leftCols(n_);
    gather(base, base.transpose() * base, columns);
    return true;
  }

  void gather(const Eigen::MatrixXd& base, const Eigen::MatrixXd& normal,
              const Eigen::MatrixXd& columns) {
    information_.resize(n_ + m_, n_ + m_);
    information_.topLeftCorner(n_, n_) = normal;
    information_.topRightCorner(n_, m_).noalias() = base.transpose() * columns;
    information_.bottomLeftCorner(m_, n_) = information_.topRightCorner(n_, m_).transpose();
    information_.bottomRightCorner(m_, m_).noalias() = columns.transpose() * columns;
    gradient_.resize(n_ + m_);
    gradient_.head(n_).noalias() = base.transpose() * residual_;
    gradient_.tail(m_).noalias() = columns.transpose() * residual_;
    for (Index j = 0; j < m_; ++j) {
      if (!get_coordinate(j).is_shape) continue;
      information_(n_ + j, n_ + j) += 1.0;
      gradient_(n_ + j) += x_(n_ + j);
    }
  }

  /// A step that leads down. Whether another may be worth it.
  bool improve() {
    for (int attempt = 0; attempt < 12; ++attempt) {
      Eigen::MatrixXd damped = information_;
      damped.diagonal() *= 1.0 + damping_;
      damped.diagonal().array() += 1e-12;
      const Eigen::VectorXd change = -damped.ldlt().solve(gradient_);
      const double expected = -gradient_.dot(change) * 2.0 - change.dot(information_ * change);
      if (expected < std::max(kEnough, kEnoughShare * chi2_)) return false;
      Eigen::VectorXd tried = x_ + change, next;
      for (Index j = 0; j < m_; ++j) {
        tried(n_ + j) = get_coordinate(j).restrain(tried(n_ + j));
      }
      if (change.allFinite() && evaluate(tried, next)) {
        const double less = next.squaredNorm() + calc_shape_chi2(tried);
        if (less < chi2_) {
          const bool goes_on = chi2_ - less >= std::max(kEnough, 0.1 * kEnoughShare * chi2_);
          x_ = tried;
          residual_ = next;
          chi2_ = less;
          damping_ = std::max(1e-6, 0.1 * damping_);
          return goes_on;
        }
      }
      damping_ = std::max(1e-3, 10.0 * damping_);
    }
    return false;
  }

  void conclude() {
    fit_.failure.clear();
    // A coordinate that was carried beyond its bound stays on it.
    fit_.values = get_point(x_);
    fit_.gain = ground_.residual.squaredNorm() - chi2_;
    Eigen::MatrixXd regular = information_;
    regular.diagonal().array() += 1e-12;
    const Eigen::MatrixXd covariance =
        regular.ldlt().solve(Eigen::MatrixXd::Identity(n_ + m_, n_ + m_));
    for (Index j = 0; j < m_; ++j) {
      const double sigma = std::sqrt(std::max(0.0, covariance(n_ + j, n_ + j)));
      const Coordinate& c = get_coordinate(j);
      const double value = fit_.values[static_cast<std::size_t>(n_ + j)];
      fit_.sigma.push_back(c.is_logarithm ? sigma * value : sigma * c.unit);
    }
  }

  const SearchGround& ground_;
  ReadingModel& model_;
  const std::vector<Coordinate> coordinates_;
  const Index n_, m_;
  Eigen::VectorXd x_;         // changes of the ground's unknowns in their scale, then coordinates
  Eigen::VectorXd residual_;  // there
  double chi2_ = 0.0, damping_ = 1e-6;
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  HypothesisFit fit_;
};

}  // namespace

HypothesisFit search_hypothesis(const SearchGround& ground, ReadingModel& model,
                                const Hypothesis& hypothesis, const std::vector<Unknown>& own,
                                const std::vector<double>& beginning) {
  return Search(ground, model, make_coordinates(hypothesis, own, beginning)).run();
}

}  // namespace strut
