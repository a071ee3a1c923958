// Figures of merit of a ride against the weighting factors that ISO 2631-1 tabulates, and against a
// run whose answers are known.
#include "jobs/simulate/ride.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

/// Gain of the weighting at one frequency, once its start has decayed.
double measure_gain(double frequency, double rate) {
  const double seconds = 20.0 + 10.0 / frequency;
  std::vector<double> wave(static_cast<std::size_t>(seconds * rate));
  for (std::size_t i = 0; i < wave.size(); ++i) {
    const double t = static_cast<double>(i) / rate;
    wave[i] = std::sin(2.0 * std::numbers::pi * frequency * t);
  }
  const std::vector<double> weighted = weight_acceleration(wave, rate);
  const auto periods = static_cast<std::size_t>(std::round(rate / frequency * 10.0));
  double in = 0.0, out = 0.0;
  for (std::size_t i = wave.size() - periods; i < wave.size(); ++i) {
    in += wave[i] * wave[i];
    out += weighted[i] * weighted[i];
  }
  return std::sqrt(out / in);
}

TEST_CASE("Vertical acceleration is weighted as ISO 2631-1 tabulates", "[reference]") {
  // Table 3 of ISO 2631-1:1997, W_k.
  constexpr std::array<std::array<double, 2>, 10> kTable = {{{0.5, 0.418},
                                                             {1.0, 0.482},
                                                             {2.0, 0.531},
                                                             {3.15, 0.804},
                                                             {5.0, 1.039},
                                                             {8.0, 1.036},
                                                             {12.5, 0.902},
                                                             {20.0, 0.636},
                                                             {40.0, 0.314},
                                                             {63.0, 0.186}}};
  for (const auto& [frequency, factor] : kTable) {
    CAPTURE(frequency);
    // The table's frequencies are nominal: 3.15 Hz stands for 10^0.5 Hz.
    CHECK(measure_gain(frequency, 1000.0) == Approx(factor).epsilon(0.012));
  }
  CHECK(measure_gain(5.0, kMinWeightedRate) == Approx(1.039).epsilon(0.012));
}

ReadChannel read_from(const LaneResults& results) {
  return [&results](int channel) { return results.get_history(channel); };
}

TEST_CASE("A ride's figures are those of its channels", "[unit]") {
  Case c = test::make_paper_case();
  c.maneuver.duration = 2.0;
  c.maneuver.road.height = 0.06;
  SamplePlan plan = test::make_plan(1e-3);
  const LaneResults results =
      list_kernels().front().run_scalar(test::prepare(c), IntegrateOptions{}, plan);
  REQUIRE(results.is_done());
  const Ride ride = calc_ride(read_from(results), 1000.0);
  double peak = 0.0, sum = 0.0;
  for (const double a : results.get_history(CarChannel::kBodyAccelerationZ)) {
    peak = std::max(peak, std::abs(a));
    sum += a * a;
  }
  CHECK(ride.peak == peak);
  CHECK(ride.rms == Approx(std::sqrt(sum / results.sample_count)));
  REQUIRE(ride.weighted);
  CHECK(*ride.weighted > 0.4 * ride.rms);
  CHECK(*ride.weighted < 1.1 * ride.rms);
  // The bump lasts less than a second of the run's two.
  REQUIRE(ride.transient);
  CHECK(*ride.transient > 1.2 * *ride.weighted);
  CHECK(*ride.transient < 1.42 * *ride.weighted);
  // At 20 m/s over 60 mm both axles lose the road for some hundredths of a second.
  for (const AxleRide& axle : ride.axles) {
    CHECK(axle.airborne > 0.005);
    CHECK(axle.airborne < 0.5);
    CHECK(axle.travel > 0.01);
    CHECK(axle.travel < 0.1);
    CHECK(axle.load_variation > 0.05);
  }
  CHECK_FALSE(calc_ride(read_from(results), kMinWeightedRate - 1.0).weighted);
  c.maneuver.road.height = 0.0;
  const LaneResults still =
      list_kernels().front().run_scalar(test::prepare(c), IntegrateOptions{}, plan);
  const Ride none = calc_ride(read_from(still), 1000.0);
  CHECK(none.peak < 0.05);
  CHECK(none.axles[0].airborne == 0.0);
  CHECK(none.axles[1].load_variation < 1e-3);
}

}  // namespace
}  // namespace strut
