// The one test of adequacy: limits, what is not finite, priors, and runs that only the held-out
// ones contradict.
#include "diagnose/compare/adequacy.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "diagnose/decide/diagnosis.h"
#include "tests/support/campaign_files.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::tolerance;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("A channel is adequate up to the scatter and the uncertainty of its noise", "[unit]") {
  // (1 + 2 * 0.02 + 0.1 * 0.5) sqrt(1 + 4 sqrt(2 / 800))
  ChannelAdequacy channel{{2.0, 0.5, 0.02}, 800, 0.0};
  const double limit = 1.09 * std::sqrt(1.2);
  CHECK(channel.calc_limit() == Approx(limit).epsilon(tolerance(1e-12)));
  channel.rms = 2.0 * limit * 0.999;
  CHECK(channel.is_adequate());
  channel.rms = 2.0 * limit * 1.001;
  CHECK_FALSE(channel.is_adequate());
}

TEST_CASE("Nothing that is not finite is adequate", "[unit]") {
  CHECK_FALSE(ChannelAdequacy{{1.0, 0.0, 0.0}, 100, kNan}.is_adequate());
  CHECK_FALSE(ChannelAdequacy{{kNan, 0.0, 0.0}, 100, 0.5}.is_adequate());
  CHECK_FALSE(ChannelAdequacy{{1.0, 0.0, kNan}, 100, 0.5}.is_adequate());
  CHECK_FALSE(ChannelAdequacy{{1.0, 0.0, 0.0}, 0, 0.0}.is_adequate());
  CHECK(ChannelAdequacy{{1.0, 0.0, 0.0}, 100, 0.5}.is_adequate());
}

TEST_CASE("The worst misfit is a failure, then the largest relative to its limit", "[unit]") {
  CHECK(find_worst({}) == nullptr);
  const Misfit slight{0, "", 0, 3.0, 2.5}, large{1, "", 1, 2.4, 1.2}, failed{2, "lost contact"};
  CHECK(find_worst({slight, large})->run == 1);
  CHECK(find_worst({slight, large, failed})->run == 2);
}

TEST_CASE("A value more than three standard deviations from its stated prior is reported",
          "[unit]") {
  Unknown length;
  length.name = "bump_length";
  length.run = 0;
  length.prior = {0.4, 0.004};
  Unknown bias = length;
  bias.kind = UnknownKind::kBias;  // a prior as wide as the motion, which nobody stated
  const auto conflicts = list_prior_conflicts({length, length, bias}, {0.498, 0.411, 0.498}, 3);
  REQUIRE(conflicts.size() == 1);
  CHECK(conflicts.front().run == 3);
  CHECK(conflicts.front().calc_distance() == Approx(24.5).epsilon(tolerance(1e-9)));
}

TEST_CASE("A value more than five standard deviations from its stated prior contradicts the model",
          "[unit]") {
  PriorConflict stated;
  stated.is_shared = true;
  stated.name = "damping";
  stated.mean = 1000.0;
  stated.sigma = 10.0;
  const auto count_misfits = [&](double value) {
    stated.value = value;
    std::vector<Misfit> misfits;
    add_misfits(CampaignData{}, {stated}, misfits);
    return misfits.size();
  };
  CHECK(count_misfits(1049.0) == 0);
  CHECK(count_misfits(1051.0) == 1);
  CHECK(count_misfits(949.0) == 1);
}

/// A rig whose strut meets a stop in the held-out run alone.
CampaignData make_stopped(const test::TemporaryFolder& folder) {
  test::QuarterTruth truth;
  truth.noise = 2e-5;
  truth.stop_gap = 0.003;
  truth.amplitude = 0.001;
  test::write_record(folder, "a.csv", test::record_quarter_car(truth));
  truth.amplitude = 0.003;
  truth.seed = 2;
  test::write_record(folder, "b.csv", test::record_quarter_car(truth));
  return read_campaign_data(test::write_campaign(folder));
}

TEST_CASE(
    "A model that only a held-out run contradicts is not adequate, and the verdict says where",
    "[statistical]") {
  const test::TemporaryFolder folder;
  const CampaignData data = make_stopped(folder);
  const Comparison comparison = compare_campaign(data);
  REQUIRE_FALSE(comparison.is_adequate());
  CHECK(are_held_out(data, comparison.misfits));
  const Diagnosis diagnosis = diagnose_campaign(data);
  CHECK(diagnosis.verdict.kind == VerdictKind::kUnknown);
  CHECK(diagnosis.verdict.unknown_share == 1.0);
  CHECK(diagnosis.misfits_before.size() == comparison.misfits.size());
  CHECK_THAT(diagnosis.sentence, Contains("agrees with the runs for fitting, but not with") &&
                                     Contains("b.csv (held out) is") &&
                                     Contains("times its noise"));
  CHECK_THAT(diagnosis.next_measurement, Contains("use b.csv for fitting"));
}

TEST_CASE("Held-out runs within their noise leave a model adequate", "[statistical]") {
  for (const std::uint64_t seed : {21U, 22U, 23U}) {
    const test::TemporaryFolder folder;
    test::QuarterTruth truth;
    truth.noise = 2e-5;
    truth.seed = seed;
    test::write_two_runs(folder, truth);
    CHECK(compare_campaign(read_campaign_data(test::write_campaign(folder))).is_adequate());
  }
}

}  // namespace
}  // namespace strut
