// Responses of rigs to the noise of their inputs.
#include "diagnose/noise/noise_spectrum.h"

#include <catch2/catch.hpp>

#include "tests/support/test_car.h"

namespace strut {
namespace {

/// A mass without a spring, whose weight nothing carries, under a force with noise.
CampaignData make_free_mass(double gravity) {
  RigSpec rig;
  rig.kind = RigKind::kSingleMass;
  rig.sprung_mass = 2.0;
  rig.damping = 8.0;
  rig.gravity = gravity;
  MeasuredRun run{"free", Model(RigCase{rig, {}}), {}, {}};
  for (int i = 0; i < 500; ++i) run.times.push_back(0.01 * i);
  const std::vector<double> zeros(run.times.size(), 0.0);
  run.setup.rig().inputs = {make_signal("force", run.times, zeros, Interpolation::kSpline)};
  run.input_noise = {{0.1, 0.0}};
  run.channels = {{SingleMassChannel::kVelocity, 1e-3, zeros}};
  CampaignData data;
  data.campaign.info = &get_rig_info(rig.kind);
  data.campaign.runs.emplace_back();
  data.tables.emplace_back();
  data.runs = {run};
  return data;
}

TEST_CASE("The fall of a mass is no response to the noise of its input", "[unit]") {
  const CampaignData weightless = make_free_mass(0.0), heavy = make_free_mass(9.81);
  const NoiseSpectrum expected = make_noise_spectra(weightless, {0}, {}, {}).front(),
                      spectrum = make_noise_spectra(heavy, {0}, {}, {}).front();
  REQUIRE(spectrum.common.size() == expected.common.size());
  // White force of 0.1 N a sample, every 0.01 s, through 1 / (2 s + 8): at rest 0.1 N / 8 N s/m.
  // The sum over samples differs from the integral by half a sample, 2 %.
  CHECK(expected.common.front()(0, 0).real() ==
        Approx(0.0125 * 0.0125).epsilon(test::tolerance(0.05)));
  for (std::size_t k = 0; k < expected.common.size(); ++k) {
    INFO(k);
    CHECK(spectrum.common[k](0, 0).real() ==
          Approx(expected.common[k](0, 0).real()).epsilon(test::tolerance(1e-6)));
  }
}

}  // namespace
}  // namespace strut
