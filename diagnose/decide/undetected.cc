#include "diagnose/decide/undetected.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/math/normal.h"

namespace strut {
namespace {

/// Normal distribution about value + shift, with this log weight.
struct Component {
  double log_weight, shift;
};

void add_components(const Undetected& u, std::size_t i, std::vector<Component>& components) {
  // Sizes below the first hardly change a score; far from a score they disagree with it.
  constexpr double kMin = 0.3, kMax = 12.0, kReach = 6.0, kMaxRatio = 0.25, kMaxStep = 0.5;
  const double score = std::abs(u.score), max = std::max(kMax, score + kReach);
  const double prior = u.prior / std::log(1e4) * (u.one_sided ? 1.0 : 0.5);
  double step = 0.0;
  for (double s = std::max(kMin, score > kMax ? score - kReach : 0.0); s < max; s += step) {
    step = std::min(kMaxRatio * s, kMaxStep);
    const auto add = [&](double size) {
      components.push_back(
          {std::log(prior * step / s) + size * u.score - 0.5 * size * size, size * u.shift[i]});
    };
    add(s);
    if (!u.one_sided) add(-s);
  }
}

/// Weighted normal distributions of the same standard deviation.
class Mixture {
 public:
  Mixture(const std::vector<Component>& components, double sigma) : sigma_(sigma) {
    constexpr double kNegligible = 1e-8;
    double max = components.front().log_weight;
    for (const Component& c : components) max = std::max(max, c.log_weight);
    for (const Component& c : components) {
      const double weight = std::exp(c.log_weight - max);
      if (weight < kNegligible) continue;
      parts_.push_back({weight, c.shift});
      sum_ += weight;
      low_ = std::min(low_, c.shift);
      high_ = std::max(high_, c.shift);
    }
  }

  double find_quantile(double p) const {
    constexpr int kHalvings = 40;
    constexpr double kReach = 6.0;  // standard deviations
    double low = low_ - kReach * sigma_, high = high_ + kReach * sigma_;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      double below = 0.0;
      for (const Part& part : parts_) {
        below += part.weight * calc_normal_probability((middle - part.shift) / sigma_);
      }
      (below < p * sum_ ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  struct Part {
    double weight, shift;
  };
  double sigma_, sum_ = 0.0, low_ = 0.0, high_ = 0.0;
  std::vector<Part> parts_;
};

/// J'J from (J'J)^-1, which has zero rows for unknowns without information. By the correlations:
/// the variances differ by many orders of magnitude.
Eigen::MatrixXd invert(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd unit = covariance.diagonal().unaryExpr(
      [](double variance) { return variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0; });
  const Eigen::MatrixXd correlation = unit.asDiagonal() * covariance * unit.asDiagonal();
  return unit.asDiagonal() * correlation.completeOrthogonalDecomposition().pseudoInverse() *
         unit.asDiagonal();
}

}  // namespace

std::vector<Undetected> list_undetected(const Evidence& evidence,
                                        const std::vector<bool>& one_sided,
                                        const std::vector<Unknown>& unknowns, double misfit) {
  const Score score = calc_score(evidence, std::vector<double>(evidence.run_count(), 1.0 / misfit));
  std::vector<double> count(one_sided.size(), 0.0);  // columns, by hypothesis
  for (const HypothesisTrial& trial : evidence.trials) {
    count[trial.hypothesis] += static_cast<double>(trial.columns.size());
  }
  std::vector<Undetected> list;
  for (const HypothesisTrial& trial : evidence.trials) {
    for (const std::size_t column : trial.columns) {
      const auto at = static_cast<Eigen::Index>(column);
      if (!is_seen(score, at)) continue;
      const double root = std::sqrt(score.covariance(at, at));
      Undetected u;
      u.prior = 1.0 / (static_cast<double>(one_sided.size()) * count[trial.hypothesis]);
      u.score = score.gradient(at) / root;
      u.one_sided = one_sided[trial.hypothesis] && trial.columns.size() == 1;
      for (std::size_t i = 0; i < evidence.shared; ++i) {
        const double correction = score.correction(static_cast<Eigen::Index>(i), at);
        u.shift.push_back(correction * unknowns[i].scale / root);
      }
      list.push_back(std::move(u));
    }
  }
  return list;
}

Interval calc_averaged_interval(double value, double sigma, std::size_t i,
                                const std::vector<Undetected>& undetected) {
  constexpr double kTail = 0.025;
  const double half = kNormal95 * sigma;
  Interval interval{value - half, value + half};
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return interval;
  std::vector<Component> components = {{0.0, 0.0}};
  for (const Undetected& u : undetected) add_components(u, i, components);
  const Mixture mixture(components, sigma);
  interval.low = std::min(interval.low, value + mixture.find_quantile(kTail));
  interval.high = std::max(interval.high, value + mixture.find_quantile(1.0 - kTail));
  return interval;
}

std::vector<double> calc_form_errors(const FitResult& fit, std::size_t count, double energy) {
  constexpr double kKappa = 8.0, kMaxFraction = 0.05;
  std::vector<double> errors(count, 0.0);
  if (!(energy > 0.0)) return errors;
  const Eigen::MatrixXd information = invert(fit.uncertainty.covariance);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double all = information(row, row), prior = fit.unknowns[i].prior.sigma;
    const double readings = all - 1.0 / (prior * prior);
    if (!(readings > 0.0)) continue;
    errors[i] = std::min(kKappa * std::sqrt(energy * readings) / all,
                         kMaxFraction * std::abs(fit.values[i]));
  }
  return errors;
}

}  // namespace strut
