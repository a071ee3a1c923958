// The score test against full least squares, thresholds against the chi-squared distribution.
#include "diagnose/hypothesis/evidence.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "diagnose/decide/probability.h"
#include "diagnose/decide/rank_trials.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Index = Eigen::Index;

Eigen::MatrixXd draw(Index rows, Index columns, std::uint64_t seed) {
  Eigen::MatrixXd m(rows, columns);
  for (Index j = 0; j < columns; ++j) {
    for (Index i = 0; i < rows; ++i) {
      m(i, j) = test::calc_test_normal(seed, static_cast<std::uint64_t>(j),
                                       static_cast<std::uint64_t>(i));
    }
  }
  return m;
}

/// Two runs of 60 readings, two shared unknowns, four columns of three hypotheses.
struct Problem {
  Eigen::MatrixXd shared[2] = {draw(60, 2, 1), draw(60, 2, 2)};
  Eigen::MatrixXd columns[2] = {draw(60, 4, 3), draw(60, 4, 4)};
  Eigen::MatrixXd residual[2] = {draw(60, 1, 5), draw(60, 1, 6)};

  Evidence gather() const {
    Evidence e;
    e.shared = 2;
    e.trials = {{0, 0, {0}, {0}}, {1, 0, {1}, {0}}, {2, 0, {2, 3}, {0, 1}}};
    for (int r = 0; r < 2; ++r) {
      Eigen::MatrixXd all(60, 7);
      all << shared[r], columns[r], residual[r];
      e.products.emplace_back(all.transpose() * all);
      e.norms.emplace_back(columns[r].colwise().squaredNorm());
    }
    e.products.emplace_back(Eigen::MatrixXd::Zero(7, 7));
    return e;
  }

  /// chi2 with the shared unknowns and some of the columns adjusted, by a QR of everything.
  double solve(const std::vector<Index>& with, bool first_run_only = false) const {
    const int runs = first_run_only ? 1 : 2;
    Eigen::MatrixXd a(60 * runs, 2 + static_cast<Index>(with.size()));
    Eigen::VectorXd b(60 * runs);
    for (int r = 0; r < runs; ++r) {
      a.block(60 * r, 0, 60, 2) = shared[r];
      for (std::size_t i = 0; i < with.size(); ++i) {
        a.block(60 * r, 2 + static_cast<Index>(i), 60, 1) = columns[r].col(with[i]);
      }
      b.segment(60 * r, 60) = residual[r];
    }
    return (b - a * a.colPivHouseholderQr().solve(b)).squaredNorm();
  }
};

TEST_CASE("A score is the fall of chi2 by least squares with the hypothesis", "[unit]") {
  const Problem problem;
  const Evidence evidence = problem.gather();
  const Score score = calc_score(evidence, {1.0, 1.0});
  const double without = problem.solve({});
  CHECK(score.chi2 == Approx(without).epsilon(test::tolerance(1e-9)));
  CHECK(calc_gain(score, {0}, false).chi2 ==
        Approx(without - problem.solve({0})).epsilon(test::tolerance(1e-8)));
  CHECK(calc_gain(score, {2, 3}, false).chi2 ==
        Approx(without - problem.solve({2, 3})).epsilon(test::tolerance(1e-8)));

  SECTION("of some of the runs, too") {
    const Score first = calc_score(evidence, {1.0, 0.0});
    CHECK(
        calc_gain(first, {1}, false).chi2 ==
        Approx(problem.solve({}, true) - problem.solve({1}, true)).epsilon(test::tolerance(1e-8)));
  }
}

TEST_CASE("A one-sided hypothesis has no score where its amplitude would be negative", "[unit]") {
  const Score score = calc_score(Problem().gather(), {1.0, 1.0});
  int refused = 0;
  for (const std::size_t column : {0U, 1U, 2U, 3U}) {
    const Gain free = calc_gain(score, {column}, false), bounded = calc_gain(score, {column}, true);
    if (free.amplitude(0) > 0.0) {
      CHECK(bounded.chi2 == free.chi2);
    } else {
      ++refused;
      CHECK(bounded.chi2 == 0.0);
    }
  }
  CHECK(refused > 0);
}

TEST_CASE("A hypothesis that free unknowns can imitate has no score", "[unit]") {
  Problem problem;
  for (int r = 0; r < 2; ++r) {
    problem.columns[r].col(0) = problem.shared[r].col(0) - 2.0 * problem.shared[r].col(1) +
                                1e-4 * problem.columns[r].col(0);
  }
  const Score score = calc_score(problem.gather(), {1.0, 1.0});
  CHECK(calc_gain(score, {0}, false).chi2 == 0.0);
}

TEST_CASE("What a run's own unknowns take over is no hypothesis, and adds nothing to the nulls",
          "[unit]") {
  // A constant force beside a sensor's bias: with that eliminated, rounding is left of it.
  Problem problem;
  Evidence evidence = problem.gather();
  for (int r = 0; r < 2; ++r) evidence.norms[r](0) *= 1e7;
  const Score score = calc_score(evidence, {1.0, 1.0});
  CHECK(calc_gain(score, {0}, false).chi2 == 0.0);
  evidence.trials = {{0, 0, {0}, {0}}};
  CHECK(draw_null_scores(evidence, score, {false}, 10).best.back() == 0.0);
}

constexpr std::size_t kDraws = 20000;

/// Null scores of a single hypothesis with one column.
NullScores draw_of_one(bool one_sided) {
  Evidence evidence;
  evidence.trials = {{0, 0, {0}, {0}}};
  Score score;
  score.covariance = Eigen::MatrixXd::Constant(1, 1, 7.0);
  score.norm = Eigen::VectorXd::Constant(1, 9.0);
  score.gradient = Eigen::VectorXd::Zero(1);
  return draw_null_scores(evidence, score, {one_sided}, kDraws);
}

TEST_CASE("The threshold of one hypothesis is a quantile of chi squared", "[unit]") {
  // Quantiles of one degree of freedom (Abramowitz and Stegun, table 26.8).
  CHECK(draw_of_one(false).get_quantile(0.95) == Approx(3.841).margin(test::tolerance(0.15)));
  CHECK(draw_of_one(false).get_quantile(0.99) == Approx(6.635).margin(test::tolerance(0.4)));
  // One-sided: half of the nulls have no score.
  CHECK(draw_of_one(true).get_quantile(0.95) == Approx(2.706).margin(test::tolerance(0.15)));
}

TEST_CASE("The p-value of a score is that of chi squared", "[unit]") {
  const NullScores nulls = draw_of_one(false);
  // One degree of freedom (Abramowitz and Stegun, table 26.8); 4 sigma of the draws.
  CHECK(nulls.calc_p_value(3.841) == Approx(0.05).margin(test::tolerance(0.0062)));
  CHECK(nulls.calc_p_value(6.635) == Approx(0.01).margin(test::tolerance(0.0028)));
  CHECK(nulls.calc_p_value(0.0) == 1.0);
  CHECK(nulls.calc_p_value(1e3) == 1.0 / (1 + kDraws));
}

TEST_CASE("Many hypotheses need a higher threshold than one", "[unit]") {
  Evidence evidence;
  Score score;
  constexpr Index kMany = 50;
  for (std::size_t i = 0; i < kMany; ++i) evidence.trials.push_back({i, 0, {i}, {0}});
  score.covariance = Eigen::MatrixXd::Identity(kMany, kMany);
  score.norm = Eigen::VectorXd::Ones(kMany);
  score.gradient = Eigen::VectorXd::Zero(kMany);
  // The largest of 50: P(chi2 < x)^50 = 0.95, x = 10.79.
  CHECK(
      draw_null_scores(evidence, score, std::vector<bool>(kMany, false), 4000).get_quantile(0.95) ==
      Approx(10.79).margin(test::tolerance(0.6)));
}

TEST_CASE("A threshold does not depend on the sizes in which effects are counted", "[unit]") {
  Evidence evidence;
  evidence.trials = {{0, 0, {0}, {0}}, {1, 0, {1}, {0}}};
  Score score;
  // Correlated by 0.9; the second is 1e9 times as large as the first.
  constexpr double kSmall = 1e-2, kLarge = 1e7;
  score.covariance.resize(2, 2);
  score.covariance << kSmall * kSmall, 0.9 * kSmall * kLarge, 0.9 * kSmall * kLarge,
      kLarge * kLarge;
  score.norm = score.covariance.diagonal();
  score.gradient = Eigen::VectorXd::Zero(2);
  const double threshold =
      draw_null_scores(evidence, score, {false, false}, 4000).get_quantile(0.99);
  // Between that of one and that of two independent ones.
  CHECK(threshold > 6.0);
  CHECK(threshold < 8.6);
}

TEST_CASE("An effect without influence on any reading is not a cause, whatever the rounding",
          "[unit]") {
  Problem problem;
  for (int r = 0; r < 2; ++r) problem.columns[r].col(0) *= 1e-12;
  const Score score = calc_score(problem.gather(), {1.0, 1.0});
  CHECK(calc_gain(score, {0}, false).chi2 == 0.0);
}

Candidate make_candidate(const std::string& place, double gain) {
  Candidate c;
  c.hypothesis.effect = "damper_asymmetry";
  c.hypothesis.place = place;
  c.hypothesis.parameters = {{place + "_damper_asymmetry", "asymmetry", true}};
  c.gain = gain;
  return c;
}

TEST_CASE("Odds follow delta chi2, and blur as it grows", "[unit]") {
  SelectRound small, large;
  small.candidates = {make_candidate("rear", 40.0), make_candidate("front", 36.0)};
  large.candidates = {make_candidate("rear", 4000.0), make_candidate("front", 3996.0)};
  const std::vector<double> near = calc_log_odds(small), far = calc_log_odds(large);
  CHECK(near[0] == 0.0);
  CHECK(near[1] < 0.0);
  CHECK(near[1] >= -2.0);
  // The same four of chi2 say less where forms differ by more.
  CHECK(far[1] > near[1]);
  CHECK(far[1] < 0.0);

  SECTION("an axle is likelier than one of its corners that explains as much") {
    small.candidates = {make_candidate("rear_left", 40.0), make_candidate("rear", 40.0)};
    const std::vector<double> odds = calc_log_odds(small);
    CHECK(odds[1] == 0.0);
    CHECK(odds[0] < 0.0);
  }
}

}  // namespace
}  // namespace strut
