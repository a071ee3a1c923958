// Effects that a campaign excludes or switches on.
#include "diagnose/campaign/campaign_effects.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "base/error/input_error.h"
#include "diagnose/compare/compare.h"
#include "diagnose/hypothesis/hypothesis.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::CampaignText;
using test::TemporaryFolder;

CampaignData read_with_effects(const std::string& effects, const test::QuarterTruth& truth = {}) {
  const TemporaryFolder folder;
  test::write_two_runs(folder, truth);
  CampaignText text;
  text.unsprung = "{ column = \"unsprung\", noise = 1e-5 }";
  text.sprung = "{ column = \"sprung\", noise = 1e-5 }";
  text.fit += "[effects]\n" + effects;
  return read_campaign_data(test::write_campaign(folder, text));
}

std::string find_refusal(const std::string& effects) {
  try {
    read_with_effects(effects);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool is_listed(const CampaignData& data, const std::string& effect) {
  const Baseline baseline = calibrate_baseline(data);
  const std::vector<Hypothesis> list = list_hypotheses(data, baseline.calibrated);
  return std::any_of(list.begin(), list.end(),
                     [&](const Hypothesis& h) { return h.effect == effect; });
}

TEST_CASE("An excluded effect is no hypothesis", "[unit]") {
  CHECK(is_listed(read_with_effects(""), "joint_play"));
  const CampaignData data = read_with_effects("exclude = [\"joint_play\"]\n");
  CHECK_FALSE(is_listed(data, "joint_play"));
  CHECK(is_listed(data, "damper_leak"));
}

TEST_CASE("An effect can be excluded at one of its places", "[unit]") {
  const CampaignData data = read_with_effects("exclude = [\"sensor_gain at sprung_position\"]\n");
  CHECK(contains(data.campaign.effects.exclude, "sensor_gain", "sprung_position"));
  CHECK_FALSE(contains(data.campaign.effects.exclude, "sensor_gain", "unsprung_position"));
}

TEST_CASE("A late recorder is a hypothesis where it delays several channels", "[unit]") {
  CampaignData data = read_with_effects("");
  CHECK(is_listed(data, "clock_offset"));
  for (MeasuredRun& run : data.runs) run.channels.resize(1);
  CHECK_FALSE(is_listed(data, "clock_offset"));
  CHECK(is_listed(data, "sensor_delay"));
}

TEST_CASE("An effect known to be present is fitted by the baseline", "[reference]") {
  test::QuarterTruth truth;
  truth.friction = 0.6;
  truth.noise = 1e-5;
  const CampaignData without = read_with_effects("", truth);
  CHECK_FALSE(compare_campaign(without).is_adequate());
  const CampaignData data = read_with_effects("on = [\"strut_friction\"]\n", truth);
  const Comparison comparison = compare_campaign(data);
  CHECK(comparison.is_adequate());
  const SharedValues& found = comparison.baseline.calibrated;
  for (std::size_t i = 0; i < found.unknowns.size(); ++i) {
    // The record's friction is smoothed over 1 cm/s, as the effect's default.
    if (found.unknowns[i].name == "strut_friction_force") {
      CHECK(found.values[i] == Approx(0.6).epsilon(test::tolerance(0.02)));
    }
    if (found.unknowns[i].name == "strut_friction_speed") {
      CHECK(found.values[i] == Approx(0.01).epsilon(test::tolerance(0.1)));
    }
  }
  CHECK(std::count_if(found.unknowns.begin(), found.unknowns.end(),
                      [](const Unknown& u) { return u.name.starts_with("strut_friction"); }) == 3);
  CHECK_FALSE(is_listed(data, "strut_friction"));
}

TEST_CASE("Effects that a campaign cannot exclude or switch on are refused", "[unit]") {
  CHECK_THAT(find_refusal("exclude = [\"joint_pley\"]\n"),
             Contains("campaign.toml:") && Contains("did you mean 'joint_play'"));
  CHECK_THAT(find_refusal("exclude = [\"gas_force\"]\n"),
             Contains("not an effect of a quarter_car"));
  CHECK_THAT(find_refusal("exclude = [\"sensor_gain at sprung_positon\"]\n"),
             Contains("did you mean 'sprung_position'"));
  CHECK_THAT(find_refusal("exclude = [\"joint_play at rear\"]\n"), Contains("is not a place"));
  CHECK_THAT(find_refusal("on = [\"sensor_bias\"]\n"), Contains("every run and channel"));
  CHECK_THAT(find_refusal("on = [\"joint_play\"]\nexclude = [\"joint_play\"]\n"),
             Contains("one of the two"));
  CHECK_THAT(find_refusal("excluded = []\n"), Contains("did you mean 'exclude'"));
}

}  // namespace
}  // namespace strut
