// Stability and classes of hypotheses, on scores written down by hand.
#include "diagnose/decide/rank_trials.h"

#include <catch2/catch.hpp>
#include <vector>

namespace strut {
namespace {

using Index = Eigen::Index;

/// Hypotheses of one column each that do not overlap, K = 1 in every run: with the scores z by run
/// and hypothesis, delta chi2 over R runs is (sum z)^2 / R.
Evidence make_evidence(const std::vector<std::vector<double>>& z_by_run) {
  Evidence e;
  const auto count = static_cast<Index>(z_by_run.front().size());
  for (std::size_t h = 0; h < z_by_run.front().size(); ++h) e.trials.push_back({h, 0, {h}, {0}});
  for (const std::vector<double>& z : z_by_run) {
    Eigen::MatrixXd products = Eigen::MatrixXd::Identity(count + 1, count + 1);
    for (Index h = 0; h < count; ++h) {
      products(h, count) = products(count, h) = -z[static_cast<std::size_t>(h)];
    }
    products(count, count) = 100.0;
    e.products.push_back(products);
    e.norms.emplace_back(Eigen::VectorXd::Ones(count));
  }
  e.products.emplace_back(Eigen::MatrixXd::Zero(count + 1, count + 1));
  return e;
}

TEST_CASE("Ranked hypotheses are those of the largest scores, each with its best start", "[unit]") {
  Evidence e = make_evidence({{1.0, 3.0, 2.0}});
  e.trials[2].hypothesis = 0;  // another start of the first
  const std::vector<RankedTrial> ranked =
      rank_trials(e, calc_score(e, {1.0}), std::vector<bool>(2, false));
  REQUIRE(ranked.size() == 2);
  CHECK(ranked[0].trial == 1);
  CHECK(ranked[0].gain.chi2 == Approx(9.0));
  CHECK(ranked[1].trial == 2);
  CHECK(ranked[1].gain.chi2 == Approx(4.0));
}

TEST_CASE("Stability is the fraction of runs without each of which an effect is among the best",
          "[unit]") {
  // All of the first effect's score is from one run.
  const Evidence e = make_evidence({{4.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}, {0.0, 1.0}});
  const std::vector<bool> free(2, false);
  // Without the first run 0 against 3; without one of the others 16 / 3 against 3.
  CHECK(calc_stability(e, free, 0) == 0.75);
  CHECK(calc_stability(e, free, 1) == 0.25);
}

TEST_CASE("An effect is among the best with 0.8 of their delta chi2", "[unit]") {
  const std::vector<bool> free(2, false);
  CHECK(calc_stability(make_evidence({{1.0, 0.90}, {1.0, 0.90}}), free, 1) == 1.0);  // 0.81
  CHECK(calc_stability(make_evidence({{1.0, 0.88}, {1.0, 0.88}}), free, 1) == 0.0);  // 0.77
}

TEST_CASE("A single run makes every effect stable", "[unit]") {
  CHECK(calc_stability(make_evidence({{2.0, 1.0}}), {false, false}, 1) == 1.0);
}

RankedTrial make_ranked(std::size_t trial, double amplitude) {
  return {trial, {1.0, Eigen::VectorXd::Constant(1, amplitude)}};
}

TEST_CASE("Effects with responses of the same shape are one class", "[unit]") {
  Evidence e = make_evidence({{1.0, 1.0, 1.0, 1.0}});
  Score score = calc_score(e, {1.0});
  // Responses of sizes 1 to 4 with these cosines to the first.
  const std::vector<double> cosines = {1.0, 0.996, 0.994, -0.996};
  for (Index i = 0; i < 4; ++i) {
    const double size = 1.0 + static_cast<double>(i);
    score.covariance(i, i) = size * size;
    if (i == 0) continue;
    score.covariance(0, i) = score.covariance(i, 0) = cosines[static_cast<std::size_t>(i)] * size;
  }
  const std::vector<RankedTrial> ranked = {make_ranked(0, 5.0), make_ranked(1, 0.1),
                                           make_ranked(2, 1.0), make_ranked(3, -2.0)};
  // The last is opposed to the first, by which the best amplitudes differ in sign, too.
  CHECK(list_classes(e, score, ranked) == std::vector<std::size_t>{0, 0, 2, 0});
  score.covariance(0, 3) = score.covariance(3, 0) = 4.0 * 0.996;
  CHECK(list_classes(e, score, ranked) == std::vector<std::size_t>{0, 0, 2, 3});
}

}  // namespace
}  // namespace strut
