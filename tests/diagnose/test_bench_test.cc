// Responses of a car's readings to hypotheses, beside what its runs leave free.
#include "diagnose/hypothesis/test_bench.h"

#include <catch2/catch.hpp>

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

/// What no free unknown takes over of a change of the road, as a fraction of its chi2.
double calc_left(const std::string& effect, double gain, const std::vector<std::string>& own) {
  const CampaignData data = make_campaign();
  const WhitenedFit fit = make_fit(data, own);
  TestBench bench(data, fit, 1);
  const Hypothesis h{effect, "road", {{"road_" + effect, "gain"}}, {{gain}}, {}, {0.0}};
  const Score score = calc_score(bench.gather({h}), {1.0, 1.0});
  return score.covariance(0, 0) / score.norm(0);
}

TEST_CASE("A common error beside runs whose own is free is a matter of their priors alone",
          "[unit]") {
  // Sizes at which readings no longer follow their tangent.
  for (const auto& [effect, own] :
       {std::pair{"speed_error", "speed"}, {"bump_height", "bump_height"}}) {
    CAPTURE(effect);
    CHECK(calc_left(effect, 0.02, {own}) < 0.01);
    CHECK(calc_left(effect, 0.02, {}) > 0.1);
  }
}

}  // namespace
}  // namespace strut
