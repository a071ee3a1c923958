// Held-out runs as the judge of models, by one noise for all.
#include "diagnose/noise/hold_out.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnose/noise/whitened_fit.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"
#include "tests/support/whitened_baseline.h"

namespace strut {
namespace {

struct Judged {
  CampaignData data;
  WhitenedFit base;
};

/// Two runs of a quarter car, the first fitted.
Judged fit_base() {
  const test::TemporaryFolder folder;
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  test::write_two_runs(folder, truth);
  CampaignData data = read_campaign_data(test::write_campaign(folder));
  WhitenedFit base = test::fit_whitened_baseline(data);
  return {std::move(data), std::move(base)};
}

TEST_CASE("A complete model leaves noise on the held-out runs, a wrong one more", "[unit]") {
  const Judged j = fit_base();
  const HoldOutJudge judge(j.data, j.base, 1);
  SharedValues shared = j.base.shared();
  const HoldOutRun right = judge.judge(shared).front();
  REQUIRE(right.failure.empty());
  CHECK(right.run == 1);
  CHECK(right.chi2 == Approx(right.expected).epsilon(test::tolerance(0.1)));
  shared.values[1] *= 1.02;
  const HoldOutRun wrong = judge.judge(shared).front();
  CHECK(wrong.chi2 > 1.2 * right.chi2);
  // By one noise the odds are those of chi2 alone.
  CHECK(wrong.log_likelihood - right.log_likelihood ==
        Approx(0.5 * (right.chi2 - wrong.chi2)).epsilon(test::tolerance(1e-12)));
}

TEST_CASE("From a wrong model to the right one held-out chi2 falls by their difference and noise",
          "[unit]") {
  const Judged j = fit_base();
  const HoldOutJudge judge(j.data, j.base, 1);
  SharedValues shared = j.base.shared();
  const std::vector<HoldOutRun> right = judge.judge(shared);
  const HoldOutRun& run = right.front();
  CHECK(run.residual.size() > static_cast<Eigen::Index>(run.count));  // and priors
  CHECK(run.residual.squaredNorm() == Approx(run.chi2).epsilon(test::tolerance(1e-9)));
  const std::vector<double> values = shared.values;
  for (const double change : {1e-4, 1e-3, 0.02}) {
    shared.values = values;
    shared.values[1] *= 1.0 + change;
    const HoldOutFall fall = calc_fall(judge.judge(shared), right, 1.0);
    REQUIRE(fall.expected > 0.0);
    CHECK(std::abs(fall.fall - fall.expected) < 6.0 * std::sqrt(fall.expected));
  }
  CHECK(calc_fall(right, right, 1.0).expected == 0.0);
  HoldOutRun failed;
  failed.failure = "lost contact";
  CHECK(calc_fall({failed}, right, 1.0).fall == 0.0);
}

TEST_CASE("Held-out runs have the noise of the fitted ones", "[unit]") {
  Judged j = fit_base();
  const std::size_t band = find_noise_band(5.0);
  j.base.spectra.front().excess[band] = 3.0;
  j.base.spectra.front().level = 0.7;
  j.base.spectra.front().response_error = 0.1;
  const HoldOutJudge judge(j.data, j.base, 1);
  CHECK(judge.get_noise(0).excess[band] == 3.0);
  CHECK(judge.get_noise(0).level == 0.7);
  CHECK(judge.get_noise(0).response_error == 0.1);
}

TEST_CASE("The likelihood of a held-out run has the determinant of its noise", "[unit]") {
  Judged j = fit_base();
  const auto measure_rest = [&](double excess) {
    std::vector<double>& bands = j.base.spectra.front().excess;
    std::fill(bands.begin(), bands.end(), excess);
    const HoldOutRun run = HoldOutJudge(j.data, j.base, 1).judge(j.base.shared()).front();
    REQUIRE(run.failure.empty());
    return std::pair{run.log_likelihood + 0.5 * run.chi2, static_cast<double>(run.count)};
  };
  // Noise e times as large: the density of each whitened number is e times lower.
  const auto [rest, count] = measure_rest(1.0);
  const double louder = measure_rest(std::exp(2.0)).first;
  CHECK(count > 1000.0);
  CHECK(rest - louder == Approx(count).epsilon(test::tolerance(1e-9)));
}

TEST_CASE("The excess of a held-out run is the mean of the fitted ones", "[unit]") {
  Judged j = fit_base();
  const std::size_t band = find_noise_band(5.0);
  j.base.spectra.push_back(j.base.spectra.front());
  j.base.spectra[0].excess[band] = 3.0;
  j.base.spectra[1].excess[band] = 2.0;
  CHECK(HoldOutJudge(j.data, j.base, 1).get_noise(0).excess[band] == 2.5);
}

TEST_CASE("A held-out run that cannot be simulated is reported and does not end a diagnosis",
          "[unit]") {
  const Judged j = fit_base();
  SharedValues shared = j.base.shared();
  shared.values[1] = -1e9;
  const std::vector<HoldOutRun> judged = HoldOutJudge(j.data, j.base, 1).judge(shared);
  CHECK_FALSE(judged.front().failure.empty());
}

}  // namespace
}  // namespace strut
