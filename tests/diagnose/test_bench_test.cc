// Responses of a car's readings to hypotheses, beside what its runs leave free.
#include "diagnose/hypothesis/test_bench.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "estimate/unknown.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

CampaignData make_campaign() {
  CampaignData data;
  data.campaign.info = &get_car_info();
  for (const double speed : {15.0, 20.0}) {
    Case c = test::make_paper_case();
    c.maneuver.speed = speed;
    c.maneuver.duration = 1.5;
    data.campaign.runs.emplace_back();
    data.tables.emplace_back();
    data.runs.push_back(test::measure(c, c, {}));
  }
  return data;
}

NoiseSpectrum make_white_noise(const MeasuredRun& run) {
  NoiseSpectrum s;
  s.samples = find_quick_length(run.times.size());
  s.interval = run.times[1] - run.times[0];
  for (const MeasuredChannel& c : run.channels) s.sigma.push_back(c.sigma);
  return s;
}

/// At the truth, front damping free; and each run's `own`, with a prior of 1 %.
WhitenedFit make_fit(const CampaignData& data, const std::vector<std::string>& own) {
  WhitenedFit fit;
  fit.shared_count = 1;
  fit.fit.unknowns = {make_parameter(data.runs, "front_damping")};
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    fit.runs.push_back(r);
    fit.spectra.push_back(make_white_noise(data.runs[r]));
    for (const std::string& name : own) {
      Unknown u = make_parameter(data.runs, name, static_cast<int>(r));
      u.prior = {u.start, 0.01 * u.start};
      fit.fit.unknowns.push_back(std::move(u));
    }
  }
  fit.fit.values = list_starts(fit.fit.unknowns);
  return fit;
}

/// The score of a relative error of the road or the speed.
Score calc_road_score(const std::string& effect, double gain, const std::vector<std::string>& own) {
  const CampaignData data = make_campaign();
  const WhitenedFit fit = make_fit(data, own);
  TestBench bench(data, fit, 1);
  const Hypothesis h{effect, "road", {{"road_" + effect, "gain"}}, {{gain}}, {}, {0.0}};
  return calc_score(bench.gather({h}), {1.0, 1.0});
}

/// Fraction of its chi2 that no free unknown takes over.
double calc_rest(const Score& score) { return score.covariance(0, 0) / score.norm(0); }

TEST_CASE("A common error beside runs whose own is free is a matter of their priors alone",
          "[unit]") {
  constexpr double kLarge = 0.02;  // where readings no longer follow their tangent
  constexpr double kSmall = 1e-4;
  for (const auto& [effect, own] :
       {std::pair{"speed_error", "speed"}, std::pair{"bump_height", "bump_height"}}) {
    CAPTURE(effect);
    const Score beside = calc_road_score(effect, kLarge, {own});
    const Score alone = calc_road_score(effect, kSmall, {});
    CHECK(calc_rest(beside) < 0.01);
    CHECK(calc_rest(alone) > 0.1);
    // Its size is that of a small difference of simulations.
    CHECK(std::sqrt(beside.norm(0)) / kLarge ==
          Approx(std::sqrt(alone.norm(0)) / kSmall).epsilon(test::tolerance(0.02)));
  }
}

}  // namespace
}  // namespace strut
