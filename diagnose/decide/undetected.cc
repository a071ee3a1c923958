#include "diagnose/decide/undetected.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/math/normal.h"

namespace strut {
namespace {

/// A share of the probability, where the unknown is `shift` from its value.
struct Part {
  double weight, shift;
};

/// Sizes of an effect, in standard deviations: below, it moves nothing, above, it is detected.
constexpr double kSmallest = 0.3, kLargest = 12.0, kRatio = 1.25;

void add_parts(const Undetected& u, std::size_t i, std::vector<Part>& parts) {
  constexpr double kNegligible = 1e-7;
  const double range = std::log(1e4);
  for (double s = kSmallest; s < kLargest; s *= kRatio) {
    const double prior = u.weight * std::log(kRatio) / range;
    const auto add = [&](double size, double share) {
      const double weight = share * prior * std::exp(size * u.score - 0.5 * size * size);
      if (weight > kNegligible) parts.push_back({weight, size * u.shift[i]});
    };
    add(s, u.one_sided ? 1.0 : 0.5);
    if (!u.one_sided) add(-s, 0.5);
  }
}

/// Where the mean of normal distributions about the parts has the probability `p`.
double find_quantile(const std::vector<Part>& parts, double sigma, double p) {
  double low = -kNormal95 * sigma, high = -low, sum = 0.0;
  for (const Part& part : parts) {
    low = std::min(low, part.shift - 10.0 * sigma);
    high = std::max(high, part.shift + 10.0 * sigma);
    sum += part.weight;
  }
  constexpr int kHalvings = 40;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const Part& part : parts) {
      below += part.weight * calc_normal_probability((middle - part.shift) / sigma);
    }
    (below < p * sum ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<Undetected> list_undetected(const Evidence& evidence, const Score& score,
                                        const std::vector<bool>& one_sided,
                                        const std::vector<Unknown>& unknowns, double misfit) {
  std::vector<Undetected> list;
  std::vector<double> starts(one_sided.size(), 0.0);  // columns of each hypothesis
  for (const HypothesisTrial& trial : evidence.trials) {
    starts[trial.hypothesis] += static_cast<double>(trial.columns.size());
  }
  const double noise = std::sqrt(misfit);
  for (const HypothesisTrial& trial : evidence.trials) {
    for (const std::size_t column : trial.columns) {
      const auto at = static_cast<Eigen::Index>(column);
      if (!is_seen(score, at)) continue;
      const double root = std::sqrt(score.covariance(at, at));
      Undetected u;
      u.weight = 1.0 / (static_cast<double>(one_sided.size()) * starts[trial.hypothesis]);
      u.score = score.gradient(at) / (root * noise);
      u.one_sided = one_sided[trial.hypothesis] && trial.columns.size() == 1;
      for (std::size_t i = 0; i < evidence.shared; ++i) {
        u.shift.push_back(score.shift(static_cast<Eigen::Index>(i), at) * unknowns[i].scale *
                          noise / root);
      }
      list.push_back(std::move(u));
    }
  }
  return list;
}

Interval calc_averaged_interval(double value, double sigma, std::size_t i,
                                const std::vector<Undetected>& undetected) {
  const double half = kNormal95 * sigma;
  Interval interval{value - half, value + half};
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return interval;
  std::vector<Part> parts = {{1.0, 0.0}};
  for (const Undetected& u : undetected) add_parts(u, i, parts);
  constexpr double kTail = 0.025;
  interval.low = std::min(interval.low, value + find_quantile(parts, sigma, kTail));
  interval.high = std::max(interval.high, value + find_quantile(parts, sigma, 1.0 - kTail));
  return interval;
}

std::vector<double> calc_form_errors(const FitResult& fit, std::size_t count, double energy) {
  constexpr double kKappa = 8.0, kMost = 0.05;
  std::vector<double> errors(count, 0.0);
  if (!(energy > 0.0)) return errors;
  const Eigen::MatrixXd information =
      fit.uncertainty.covariance.completeOrthogonalDecomposition().pseudoInverse();
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double prior = fit.unknowns[i].prior.sigma;
    const double readings = information(row, row) - 1.0 / (prior * prior);
    if (!(readings > 0.0)) continue;
    errors[i] = std::min(kKappa * std::sqrt(energy / readings), kMost * std::abs(fit.values[i]));
  }
  return errors;
}

}  // namespace strut
