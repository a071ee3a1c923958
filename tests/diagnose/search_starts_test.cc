// Start values of the search are within the reach of the first order.
#include "diagnose/hypothesis/search_starts.h"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <string>

#include "model/effects/catalogue.h"
#include "model/effects/names.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

/// The body's vertical acceleration while a car crosses the bump, at a relative error of `effect`.
Eigen::VectorXd simulate(const std::string& effect, double error) {
  Case c = test::make_paper_case();
  c.maneuver.duration = 1.5;
  if (error != 0.0) c.vehicle.effects = {{effect, "road", {error}}};
  SamplePlan plan;
  plan.interval = 2e-3;
  plan.snapshot = false;
  plan.recorded = {CarChannel::kBodyAccelerationZ};
  const LaneResults run = list_kernels().front().run_scalar(test::prepare(c), {}, plan);
  const std::vector<double> samples = run.get_history(0);
  return Eigen::Map<const Eigen::VectorXd>(samples.data(),
                                           static_cast<Eigen::Index>(samples.size()));
}

TEST_CASE("Errors of road and speed start where the readings follow their tangent", "[unit]") {
  for (const char* effect :
       {EffectName::kSpeedError, EffectName::kBumpHeight, EffectName::kBumpLength}) {
    CAPTURE(effect);
    const double start = choose_search_starts(effect, {}).front().at("gain"), step = 1e-5;
    const Eigen::VectorXd tangent =
        start / (2.0 * step) * (simulate(effect, step) - simulate(effect, -step));
    const Eigen::VectorXd response = simulate(effect, start) - simulate(effect, 0.0);
    CHECK(tangent.norm() > 0.0);
    CHECK((response - tangent).norm() < 0.15 * tangent.norm());
  }
}

}  // namespace
}  // namespace strut
