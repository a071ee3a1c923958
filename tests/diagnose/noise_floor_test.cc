// Floors of channels from spectra written down by hand, and the priors of sensor errors.
#include "diagnose/noise/noise_floor.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "diagnose/campaign/campaign_unknowns.h"
#include "tests/support/strut_stand.h"
#include "tests/support/test_car.h"
#include "tests/support/tolerance.h"

namespace strut {
namespace {

using test::tolerance;

constexpr std::size_t kSamples = 100;
constexpr double kInterval = 0.02;  // s

/// A run of one channel whose noise is known to 3 %.
CampaignData make_campaign(const Model& model, int channel) {
  CampaignData data;
  data.campaign.info = &model.info();
  MeasuredRun run{"run", model, {}, {}};
  run.channels = {{channel, 2.0, {}}};
  test::add_run(run, data);
  CampaignColumn column;
  column.channel = data.info(channel).name;
  data.campaign.columns = {column};
  NoiseEstimate noise;
  noise.uncertainty = 0.03;
  data.noise = {noise};
  return data;
}

/// White noise of 2^2, drift of 0.3^2 of that, and 6 from common sources.
NoiseSpectrum make_spectrum() {
  NoiseSpectrum s;
  s.samples = kSamples;
  s.interval = kInterval;
  s.sigma = {2.0};
  s.level = 0.5;
  s.common.assign(kSamples / 2 + 1, Eigen::MatrixXcd::Constant(1, 1, 12.0));
  // The drift's mean square in a record: f_c T (2 + 2/2 + ... + 2/49 + 1/50) / 100.
  double sum = 1.0 / 50.0;
  for (int k = 1; k < 50; ++k) sum += 2.0 / k;
  SensorColor drift;
  drift.corner = 0.09 * kSamples / (sum * kSamples * kInterval);
  s.color = {drift};
  return s;
}

TEST_CASE("A rig's floor has its sensor's white noise, drift, and what comes from its inputs",
          "[unit]") {
  RigSpec rig;
  rig.kind = RigKind::kStrutRig;
  const CampaignData data = make_campaign(Model(RigCase{rig, {}}), StrutRigChannel::kForce);
  const NoiseFloor floor = calc_noise_floor(data, 0, 0, make_spectrum());
  CHECK(floor.sigma == Approx(std::sqrt(4.0 + 0.36 + 6.0)).epsilon(tolerance(1e-9)));
  CHECK(floor.common_fraction == Approx(6.36 / 10.36).epsilon(tolerance(1e-9)));
  CHECK(floor.uncertainty == 0.03);
  // All of the drift, a tenth of the inputs' noise.
  CHECK(floor.common_tolerance == Approx((0.36 + 0.1 * 6.0) / 6.36).epsilon(tolerance(1e-9)));
}

TEST_CASE("A car's floor may be off by all of its road", "[unit]") {
  const Case c = test::make_paper_case();
  const CampaignData data = make_campaign(Model(c), CarChannel::kBodyAccelerationZ);
  const NoiseFloor floor = calc_noise_floor(data, 0, 0, make_spectrum());
  CHECK(floor.sigma == Approx(std::sqrt(10.36)).epsilon(tolerance(1e-9)));
  CHECK(floor.common_tolerance == Approx(1.0).epsilon(tolerance(1e-9)));
}

TEST_CASE("White noise alone has no common part", "[unit]") {
  const Case c = test::make_paper_case();
  NoiseSpectrum white = make_spectrum();
  white.common.clear();
  white.color.clear();
  const NoiseFloor floor =
      calc_noise_floor(make_campaign(Model(c), CarChannel::kBodyAccelerationZ), 0, 0, white);
  CHECK(floor.sigma == Approx(2.0).epsilon(tolerance(1e-12)));
  CHECK(floor.common_fraction == 0.0);
}

TEST_CASE("Sensor errors of a rig contain those of its recorded inputs", "[unit]") {
  CampaignData data = test::make_stand({{0.01, 1.0}});
  data.campaign.fit.free = {"damping"};
  data.campaign.noise.sensor = {1e-3, 2e-5};
  const std::vector<Unknown> unknowns = make_free_unknowns(data, {0});
  REQUIRE(unknowns.size() == 3);
  CHECK(unknowns[1].kind == UnknownKind::kSensorGain);
  CHECK(unknowns[1].prior.mean == 0.0);
  // Two independent errors of equal size.
  CHECK(unknowns[1].prior.sigma == Approx(std::hypot(1e-3, 1e-3)).epsilon(tolerance(1e-12)));
  CHECK(unknowns[2].kind == UnknownKind::kSensorSkew);
  CHECK(unknowns[2].prior.sigma == Approx(std::hypot(2e-5, 2e-5)).epsilon(tolerance(1e-12)));
}

TEST_CASE("A run whose channels are mostly sensor noise can be held against priors", "[unit]") {
  const auto make = [](double fraction) {
    NoiseFloor floor;
    floor.common_fraction = fraction;
    return floor;
  };
  CHECK(is_mostly_white({make(0.0), make(0.49)}));
  CHECK_FALSE(is_mostly_white({make(0.0), make(0.51)}));
}

}  // namespace
}  // namespace strut
