// The residual of a model in whose readings a tone of known power is hidden.
#include "diagnose/discrepancy/leftover.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "estimate/simulate_run.h"
#include "tests/support/strut_stand.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

TEST_CASE("The significance of a chi2 is that of its tail", "[unit]") {
  // Quantiles of one in a thousand, 3.090 sigmas (Abramowitz and Stegun, table 26.8); the cube root
  // is normal to a hundredth from 10 degrees of freedom on.
  CHECK(calc_chi2_significance(29.588, 10.0, 10.0) == Approx(3.090).margin(tolerance(0.03)));
  CHECK(calc_chi2_significance(149.449, 100.0, 100.0) == Approx(3.090).margin(tolerance(0.02)));
  // The median is 0 sigmas.
  CHECK(calc_chi2_significance(9.342, 10.0, 10.0) == Approx(0.0).margin(tolerance(0.01)));
  // Of noise that may be larger by a tenth.
  CHECK(calc_chi2_significance(1.1 * 149.449, 110.0, 100.0) ==
        Approx(3.090).margin(tolerance(0.02)));
  CHECK(calc_chi2_significance(1e9, 0.1, 0.5) == 0.0);
}

/// The damper of a stand, with readings that have a tone of 5 Hz and `amplitude` sigmas in place of
/// noise: 800 samples in 4 s, so that its chi2, 400 amplitude^2, is in one frequency of 400.
Leftover measure_tone(double amplitude) {
  CampaignData data = test::make_stand({{0.01, 1.0}});
  MeasuredRun& run = data.runs[0];
  const RunCurves curves = simulate_run(run, {}, {});
  run.channels[0].values = curves.channel[StrutRigChannel::kForce];
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    run.channels[0].values[i] +=
        amplitude * test::kStandSigma * std::cos(2.0 * std::numbers::pi * 5.0 * run.times[i]);
  }
  WhitenedFit fit;
  fit.runs = {0};
  fit.spectra = {test::make_white_noise(run)};
  fit.shared_count = 1;
  fit.fit.unknowns = {make_shared_unknown(data.runs, "damping")};
  fit.fit.values = {test::kStandDamping};
  TestBench bench(data, fit, 1);
  return measure_leftover(data, bench);
}

TEST_CASE("A tone is as significant as its chi2 in a line of two frequencies", "[unit]") {
  const Leftover left = measure_tone(0.5);
  // chi2 of 100 in four numbers, which noise may exceed by 5 %, in Wilson and Hilferty's form.
  const double expected = (std::cbrt(100.0 / 4.2) - (1.0 - 1.0 / 18.0)) * std::sqrt(18.0);
  CHECK(expected > 8.0);
  CHECK(left.significance == Approx(expected).epsilon(tolerance(1e-3)));
  CHECK(left.band.from == Approx(4.75));
  CHECK(left.band.to == Approx(5.25));
  // Its band, 3 to 8 Hz, stands out by more than 3 sigmas; noise would have a chi2 of 40 there.
  CHECK(left.energy == Approx(100.0 - 40.0).epsilon(tolerance(1e-3)));
}

TEST_CASE("A tone below six sigmas of noise has no energy", "[unit]") {
  const Leftover left = measure_tone(0.3);
  CHECK(left.significance ==
        Approx((std::cbrt(36.0 / 4.2) - 17.0 / 18.0) * std::sqrt(18.0)).epsilon(tolerance(1e-3)));
  CHECK(left.energy == 0.0);
  CHECK(left.places.empty());
}

TEST_CASE("A location is stated where it explains the residual by five standard deviations",
          "[unit]") {
  Leftover left;
  CHECK(find_clear_place(left) == nullptr);
  left.places = {{"front", "strut", 49.0, 10.0}, {"rear", "strut", 20.0, 4.0}};
  REQUIRE(find_clear_place(left) != nullptr);
  CHECK(find_clear_place(left)->name == "rear");
  left.places[0].energy = 51.0;
  CHECK(find_clear_place(left)->name == "front");
  left.places = {{"rear", "strut", 19.9, 4.0}};
  CHECK(find_clear_place(left) == nullptr);
}

}  // namespace
}  // namespace strut
