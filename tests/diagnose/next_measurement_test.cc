// Proposed runs: that the stand can make them, and what they promise, on problems solved by hand.
#include "diagnose/decide/next_measurement.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "diagnose/decide/possible_runs.h"
#include "diagnose/decide/separation.h"
#include "model/effects/names.h"
#include "tests/support/strut_stand.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

using test::add_run;
using test::kStandDamping;
using test::kStandSigma;
using test::make_stand;
using test::make_white_noise;

SharedValues set_damping(double damping) {
  Unknown u;
  u.name = "damping";
  return {{u}, {damping}};
}

/// Two dampers that differ by `difference` of `effect` times the nominal one, and the nominal one.
Rivals make_rivals(double effect, double difference) {
  return {set_damping(kStandDamping * (1.0 + effect)),
          set_damping(kStandDamping * (1.0 + effect + difference)),
          set_damping(kStandDamping),
          1.0,
          {},
          {}};
}

double measure_travel(const MeasuredRun& run) {
  double low = 0.0, high = 0.0;
  for (const double t : run.times) {
    const double value = calc_signal(run.setup.rig().inputs[0], t).value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high - low;
}

TEST_CASE("The separation promised is that of two forces known in closed form", "[unit]") {
  constexpr double kAmplitude = 0.02, kFrequency = 1.0;  // whole periods
  const CampaignData data = make_stand({{kAmplitude, kFrequency}});
  const NoiseSpectrum noise = make_white_noise(data.runs[0]);
  const auto count = static_cast<double>(data.runs[0].times.size());
  const double speed = 2.0 * std::numbers::pi * kFrequency * kAmplitude / std::sqrt(2.0);  // rms
  const auto expect = [&](double part) {
    return count * std::pow(part * kStandDamping * speed / kStandSigma, 2.0);
  };
  Rivals rivals = make_rivals(0.2, 0.005);
  // The spline of 200 points a period errs by 1e-6, its ends by more.
  const double close = tolerance(1e-3);
  CHECK(calc_chi2_between(data, noise, rivals, rivals.a, rivals.b) ==
        Approx(expect(0.005)).epsilon(close));
  CHECK(bound_chi2_between(data, noise, rivals) == Approx(expect(0.005)).epsilon(close));
  rivals.misfit = 2.5;
  const double temperature = 1.0 + 0.004 * expect(0.2) / 2.5;
  CHECK(temperature > 10.0);
  CHECK(calc_separation(data, noise, rivals) ==
        Approx(std::sqrt(expect(0.005) / (2.5 * temperature))).epsilon(close));
}

TEST_CASE("What a fit adjusts does not separate", "[unit]") {
  const CampaignData data = make_stand({{0.02, 1.0}});
  Rivals rivals = make_rivals(0.2, 0.05);
  rivals.shared = {make_shared_unknown(data.runs, "damping")};
  rivals.values = {kStandDamping * 1.2};
  const NoiseSpectrum noise = make_white_noise(data.runs[0]);
  const double bound = bound_chi2_between(data, noise, rivals);
  CHECK(bound > 100.0);
  CHECK(calc_chi2_between(data, noise, rivals, rivals.a, rivals.b) < 1e-6 * bound);
  // The existing runs know the damping to a thousandth of the difference.
  rivals.shared[0].prior = {kStandDamping * 1.2, 1e-3 * 0.05 * kStandDamping};
  CHECK(calc_chi2_between(data, noise, rivals, rivals.a, rivals.b) ==
        Approx(bound).epsilon(tolerance(1e-2)));
}

TEST_CASE("A crank with one stroke has no other amplitude", "[unit]") {
  const CampaignData data = make_stand({{0.018, 1.0}, {0.018, 2.0}});
  CHECK(list_possible_runs(data, 0).empty());
  CHECK(list_possible_runs(data, 1).empty());
}

TEST_CASE("Proposed amplitudes stay within the recorded travel and speed", "[unit]") {
  // The largest travel was recorded at a sixth of the fastest run's speed.
  const CampaignData data = make_stand({{0.002, 2.0}, {0.01, 0.4}, {0.004, 6.0}});
  std::size_t count = 0;
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    for (const PossibleRun& run : list_possible_runs(data, r)) {
      INFO(run.description);
      const MeasuredRun& changed = run.data.runs[0];
      const double factor = measure_travel(changed) / measure_travel(data.runs[r]);
      CHECK(measure_travel(changed) <= 0.02 * (1.0 + 1e-6));
      CHECK(measure_travel(changed) >= 0.004 * (1.0 - 1e-6));
      const double frequency[] = {2.0, 0.4, 6.0};
      CHECK(0.5 * measure_travel(changed) * frequency[r] <= 0.004 * 6.0 * (1.0 + 1e-3));
      const std::string number = fmt::format("{:.2g} times", factor);
      CHECK(run.description.find("run_" + std::to_string(r) + " at " + number) !=
            std::string::npos);
      ++count;
    }
  }
  CHECK(count >= 4);
}

CampaignData make_crossings() {
  CampaignData data;
  data.campaign.info = &get_car_info();
  for (const auto& [speed, height] : {std::pair{5.0, 0.05}, {10.0, 0.05}, {6.0, 0.08}}) {
    Case c = test::make_paper_case();
    c.maneuver.speed = speed;
    c.maneuver.bump_distance = 1.7 * speed;
    c.maneuver.road.shape = BumpShape::kCosine;
    c.maneuver.road.height = height;
    c.maneuver.road.length = 1.0;
    add_run({"run_" + std::to_string(data.run_count()), Model(c), {0.0, 0.1}, {}}, data);
  }
  return data;
}

TEST_CASE("A proposed crossing meets an existing bump at the time and speed that it says",
          "[unit]") {
  const CampaignData data = make_crossings();
  std::size_t bumps = 0, count = 0;
  for (std::size_t r = 0; r < data.run_count(); ++r) {
    for (const PossibleRun& run : list_possible_runs(data, r)) {
      INFO(run.description);
      const ManeuverSpec& maneuver = run.data.runs[0].setup.car().maneuver;
      CHECK(maneuver.bump_distance / maneuver.speed == Approx(1.7));
      CHECK(maneuver.speed <= 10.0 * (1.0 + 1e-9));
      const bool is_known = maneuver.road == data.runs[0].setup.car().maneuver.road ||
                            maneuver.road == data.runs[2].setup.car().maneuver.road;
      CHECK(is_known);
      const std::string speed = std::to_string(std::lround(3.6 * maneuver.speed)) + " km/h";
      CHECK(3.6 * maneuver.speed == Approx(std::round(3.6 * maneuver.speed)));
      CHECK(run.description.find("at " + speed) != std::string::npos);
      bumps += run.description.find("bump of") != std::string::npos ? 1 : 0;
      ++count;
    }
  }
  CHECK(bumps == 3);
  CHECK(count > 6);
}

/// A selection whose only round leaves two hypotheses that change the damper by nothing and by a
/// fraction.
Selection make_selection(const CampaignData& data, double fraction) {
  Selection selection;
  selection.extended.runs = {0};
  selection.extended.spectra = {make_white_noise(data.runs[0])};
  SelectRound round;
  for (const auto& [effect, value] :
       {std::pair{EffectName::kDamperAsymmetry, 0.0}, {EffectName::kDamperBlowOff, fraction}}) {
    Candidate c;
    c.hypothesis.effect = effect;
    c.hypothesis.parameters = {{"damping", "", false}};
    c.shared = set_damping(kStandDamping * (1.0 + value));
    round.candidates.push_back(std::move(c));
  }
  selection.rounds.push_back(std::move(round));
  return selection;
}

TEST_CASE("A separation is promised from three standard deviations on", "[unit]") {
  const CampaignData data = make_stand({{0.002, 1.0}, {0.008, 1.0}});
  const auto count = static_cast<double>(data.runs[0].times.size());
  // Standard deviations by which the first run separates dampers that differ by all of it.
  const double whole =
      std::sqrt(0.5 * count) * kStandDamping * 2.0 * std::numbers::pi * 0.002 / kStandSigma;
  const auto propose = [&](double sigmas) {
    const Cause a{EffectName::kDamperAsymmetry, "", 0.5, 0.0, {}};
    const Cause b{EffectName::kDamperBlowOff, "", 0.5, 0.0, {}};
    return propose_measurement(data, make_selection(data, sigmas / whole), {a, b});
  };
  CHECK(propose(0.7) ==
        "no amplitude that the recorded runs show to be possible separates damper_asymmetry from "
        "damper_blow_off by 3 standard deviations; add another sensor");
  CHECK(propose(0.8) ==
        "repeat run_0 at 4 times its amplitude: separates damper_asymmetry from damper_blow_off by "
        "3.2 standard deviations (0.8 in the existing runs)");
  CHECK(propose(2.9) ==
        "repeat run_0 at 4 times its amplitude: separates damper_asymmetry from damper_blow_off by "
        "11.6 standard deviations (2.9 in the existing runs)");
  // No run of which the existing ones have enough.
  CHECK(propose(91.0).find("standard deviations") == std::string::npos);
}

TEST_CASE("A separation that a fit adjusts away is not promised", "[unit]") {
  const CampaignData data = make_stand({{0.002, 1.0}, {0.008, 1.0}});
  const auto count = static_cast<double>(data.runs[0].times.size());
  // As above; the existing runs know the damping half as well as the first at 4 times its amplitude
  // would, which takes sqrt(2) of its separation.
  const double whole =
      std::sqrt(0.5 * count) * kStandDamping * 2.0 * std::numbers::pi * 0.002 / kStandSigma;
  const auto propose = [&](double sigmas) {
    Selection selection = make_selection(data, sigmas / whole);
    selection.base.shared_count = 1;
    selection.base.fit.unknowns = {make_shared_unknown(data.runs, "damping")};
    selection.base.fit.widened.sigma = {kStandDamping / (4.0 * whole)};
    const Cause a{EffectName::kDamperAsymmetry, "", 0.5, 0.0, {}};
    const Cause b{EffectName::kDamperBlowOff, "", 0.5, 0.0, {}};
    return propose_measurement(data, selection, {a, b});
  };
  CHECK(propose(1.0).find("no amplitude that the recorded runs show") == 0);  // 2.8
  CHECK(propose(1.1).find("by 3.1 standard deviations (1.1 in the existing runs)") !=
        std::string::npos);
}

TEST_CASE("A car's proposal names a bump and a speed", "[unit]") {
  CampaignData data = make_crossings();
  for (MeasuredRun& run : data.runs) {
    run.times.clear();
    for (int i = 0; i < 400; ++i) run.times.push_back(0.005 * i);
    run.channels = {{CarChannel::kBodyAccelerationZ, 0.0, std::vector<double>(400, 0.0)}};
  }
  const auto propose = [&](double sigma) {
    for (MeasuredRun& run : data.runs) run.channels[0].sigma = sigma;
    Selection selection = make_selection(data, 0.0);
    selection.extended.spectra[0].sigma = {sigma};
    std::vector<Candidate>& candidates = selection.rounds[0].candidates;
    Unknown front, rear;
    front.name = "front_damping";
    rear.name = "rear_damping";
    candidates[0].shared = {{front}, {2100.0}};
    candidates[1].shared = {{rear}, {2100.0}};
    const Cause a{EffectName::kDamperAsymmetry, "", 0.5, 0.0, {}};
    const Cause b{EffectName::kDamperBlowOff, "", 0.5, 0.0, {}};
    return propose_measurement(data, selection, {a, b});
  };
  CHECK(propose(100.0).find("no speed or bump") == 0);
  CHECK(propose(1e-4).find("standard deviations") == std::string::npos);
  // Noise at which the existing run separates them by 1 sigma at most, and 9 km/h more by 3.
  std::string proposal;
  for (double sigma = 10.0; sigma > 1e-3 && proposal.find("km/h: ") == std::string::npos;
       sigma /= 1.3) {
    proposal = propose(sigma);
  }
  CHECK(proposal.find(" standard deviations (") != std::string::npos);
}

TEST_CASE("The priors of rivals are as wide as the intervals of the calibrated model", "[unit]") {
  const CampaignData data = make_stand({{0.002, 1.0}});
  Selection selection = make_selection(data, 0.1);
  selection.base.shared_count = 1;
  selection.base.fit.unknowns = {make_shared_unknown(data.runs, "damping")};
  selection.base.fit.uncertainty.sigma = {2.0};
  selection.base.fit.widened.sigma = {7.0};
  const auto rivals = find_rivals(data, selection, EffectName::kDamperAsymmetry, "",
                                  EffectName::kDamperBlowOff, "");
  REQUIRE(rivals);
  REQUIRE(rivals->shared.size() == 1);
  CHECK(rivals->shared[0].prior.mean == kStandDamping);
  CHECK(rivals->shared[0].prior.sigma == 7.0);
}

TEST_CASE("Without a group no amplitude is proposed that a crank cannot make", "[unit]") {
  const CampaignData crank = make_stand({{0.018, 1.0}, {0.018, 2.0}}),
                     plate = make_stand({{0.002, 1.0}, {0.008, 1.0}});
  Selection selection = make_selection(crank, 0.0);
  selection.is_left = true;
  CHECK(propose_measurement(crank, selection, {}).find("amplitude") == std::string::npos);
  CHECK(propose_measurement(plate, selection, {}).find("amplitude") != std::string::npos);
}

}  // namespace
}  // namespace strut
