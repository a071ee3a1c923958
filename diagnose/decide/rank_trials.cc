#include "diagnose/decide/rank_trials.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/math/normal.h"

namespace strut {
namespace {

/// Cosine of the responses to two trials at the sizes that their scores ask for, beside what the
/// free parameters absorb.
double calc_cosine(const Score& score, const HypothesisTrial& a, const Eigen::VectorXd& sizes_a,
                   const HypothesisTrial& b, const Eigen::VectorXd& sizes_b) {
  const auto calc_product = [&](const HypothesisTrial& s, const Eigen::VectorXd& x,
                                const HypothesisTrial& t, const Eigen::VectorXd& y) {
    double sum = 0.0;
    for (std::size_t i = 0; i < s.columns.size(); ++i) {
      for (std::size_t j = 0; j < t.columns.size(); ++j) {
        sum += x(static_cast<Eigen::Index>(i)) * y(static_cast<Eigen::Index>(j)) *
               score.covariance(static_cast<Eigen::Index>(s.columns[i]),
                                static_cast<Eigen::Index>(t.columns[j]));
      }
    }
    return sum;
  };
  const double aa = calc_product(a, sizes_a, a, sizes_a), bb = calc_product(b, sizes_b, b, sizes_b);
  return aa > 0.0 && bb > 0.0 ? calc_product(a, sizes_a, b, sizes_b) / std::sqrt(aa * bb) : 0.0;
}

}  // namespace

std::vector<RankedTrial> rank_trials(const Evidence& evidence, const Score& score,
                                     const std::vector<bool>& one_sided) {
  std::map<std::size_t, RankedTrial> best;
  for (std::size_t t = 0; t < evidence.trials.size(); ++t) {
    const HypothesisTrial& trial = evidence.trials[t];
    const Gain gain = calc_gain(score, trial.columns, one_sided[trial.hypothesis]);
    const auto found = best.find(trial.hypothesis);
    if (found != best.end() && found->second.gain.chi2 >= gain.chi2) continue;
    best[trial.hypothesis] = {t, gain};
  }
  std::vector<RankedTrial> list;
  list.reserve(best.size());
  for (const auto& [hypothesis, ranked] : best) list.push_back(ranked);
  std::stable_sort(list.begin(), list.end(), [](const RankedTrial& a, const RankedTrial& b) {
    return a.gain.chi2 > b.gain.chi2;
  });
  return list;
}

double calc_stability(const Evidence& evidence, const std::vector<bool>& one_sided,
                      std::size_t hypothesis) {
  constexpr double kStays = 0.8;
  if (evidence.run_count() < 2) return 1.0;
  double stays = 0.0;
  for (std::size_t r = 0; r < evidence.run_count(); ++r) {
    std::vector<double> weights(evidence.run_count(), 1.0);
    weights[r] = 0.0;
    const Score score = calc_score(evidence, weights);
    const std::vector<RankedTrial> ranked = rank_trials(evidence, score, one_sided);
    const auto own = std::find_if(ranked.begin(), ranked.end(), [&](const RankedTrial& t) {
      return evidence.trials[t.trial].hypothesis == hypothesis;
    });
    if (own != ranked.end() && own->gain.chi2 >= kStays * ranked.front().gain.chi2) ++stays;
  }
  return stays / static_cast<double>(evidence.run_count());
}

std::vector<std::size_t> list_classes(const Evidence& evidence, const Score& score,
                                      const std::vector<RankedTrial>& ranked) {
  constexpr double kSame = 0.995;
  std::vector<std::size_t> classes;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    std::size_t first = 0;
    while (first < i &&
           calc_cosine(score, evidence.trials[ranked[first].trial], ranked[first].gain.amplitude,
                       evidence.trials[ranked[i].trial], ranked[i].gain.amplitude) < kSame) {
      ++first;
    }
    classes.push_back(first < i ? classes[first] : i);
  }
  return classes;
}

double NullScores::get_quantile(double confidence) const {
  const auto at = static_cast<std::size_t>(confidence * static_cast<double>(best.size()));
  return best[std::min(best.size() - 1, at)];
}

double NullScores::calc_p_value(double score) const {
  const auto from = std::lower_bound(best.begin(), best.end(), score);
  return static_cast<double>(1 + (best.end() - from)) / static_cast<double>(1 + best.size());
}

NullScores draw_null_scores(const Evidence& evidence, const Score& score,
                            const std::vector<bool>& one_sided, std::size_t draws) {
  constexpr std::uint64_t kSeed = 1;
  // The root of the correlation matrix: effects differ in size by orders of magnitude, and rounding
  // errors of the largest must not count as noise of the smallest.
  const Eigen::VectorXd sigma = score.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd unit = sigma.unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit.asDiagonal() * score.covariance *
                                                              unit.asDiagonal());
  const Eigen::MatrixXd root = sigma.asDiagonal() * solver.eigenvectors() *
                               solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  NullScores scores;
  scores.best.reserve(draws);
  Score null = score;
  for (std::size_t i = 0; i < draws; ++i) {
    Eigen::VectorXd normal(root.cols());
    for (Eigen::Index k = 0; k < normal.size(); ++k) {
      normal(k) = calc_normal(kSeed, i, static_cast<std::uint64_t>(k));
    }
    null.gradient = root * normal;
    double best = 0.0;
    for (const HypothesisTrial& trial : evidence.trials) {
      best = std::max(best, calc_gain(null, trial.columns, one_sided[trial.hypothesis]).chi2);
    }
    scores.best.push_back(best);
  }
  std::sort(scores.best.begin(), scores.best.end());
  return scores;
}

}  // namespace strut
