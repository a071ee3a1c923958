// Channels of runs as sensors read them: against closed forms, and what sensors must leave
// unchanged.

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "io/table/csv.h"
#include "model/rig/rig_system.h"
#include "model/sensor/read_out.h"
#include "sweep/simulate_cases.h"
#include "tests/support/run_shell.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

using test::tolerance;
using C = CarChannel;

constexpr double kW = 2.0 * 3.14159265358979323846 * 4.0, kSize = 0.01;

/// A strut on a sine of 4 Hz, read every `interval` [s].
LaneResults read_strut(const EffectSettings& effects, double interval) {
  RigSpec spec;
  spec.kind = RigKind::kStrutRig;
  spec.stiffness = 20000.0;
  spec.damping = 1500.0;
  spec.effects = effects;
  SamplePlan plan;
  plan.duration = 1.0;
  plan.interval = interval;
  plan.snapshot = false;
  StepOptions options;
  options.step = 5e-3;
  const ReadOut out(get_rig_info(spec.kind).channels, {&spec.effects});
  return simulate_readings(out, plan, [&](const SamplePlan& record) {
    return simulate_rig(spec, {make_chirp("displacement", kSize, 4.0, 4.0, 1.0)}, options, record);
  });
}

double get_strut(const LaneResults& run, int sample, int channel) {
  const int at = sample * StrutRigChannel::kCount + channel;
  return run.history[static_cast<std::size_t>(at)];
}

TEST_CASE("A rig's channels agree with the closed form of filter and delay at any sample rate",
          "[unit][reference][effects]") {
  const double interval = GENERATE(2e-2, 1e-3, 5e-4);
  const double late = 4.3e-3, slow = 6e-3, gain = 0.07, bias = -2e-3;
  const LaneResults run = read_strut({{"sensor_delay", "displacement", {late}},
                                      {"sensor_lowpass", "displacement", {slow}},
                                      {"sensor_gain", "displacement", {gain}},
                                      {"sensor_bias", "displacement", {bias}}},
                                     interval);
  const LaneResults plain = read_strut({}, interval);
  REQUIRE(run.sample_count == plain.sample_count);
  REQUIRE(run.history.size() == plain.history.size());
  const double ratio = kW * slow;
  for (int i = 0; i < run.sample_count; ++i) {
    const double t = interval * i - late;
    const double settled = std::sin(kW * t) - ratio * std::cos(kW * t);
    const double z =
        t < 0.0 ? 0.0 : (settled + ratio * std::exp(-t / slow)) / (1.0 + ratio * ratio);
    // Splines over 1 ms; the sine starts from rest with a kink, which they round off.
    const double exact = kSize * (1.0 + gain) * z + bias;
    const double margin = t < 0.01 ? 3e-3 * kSize : 2e-7 * kSize;
    CHECK(std::fabs(get_strut(run, i, StrutRigChannel::kDisplacement) - exact) < tolerance(margin));
    // Channels derived from the displacement have sensors of their own.
    for (int c = 0; c < StrutRigChannel::kCount; ++c) {
      if (c == StrutRigChannel::kDisplacement) continue;
      CHECK(get_strut(run, i, c) == get_strut(plain, i, c));
    }
  }
}

Case make_case(const EffectSettings& effects) {
  Case c = test::make_paper_case();
  c.vehicle.effects = effects;
  c.maneuver.duration = 1.0;
  c.maneuver.bump_distance = 3.0;
  return c;
}

IntegrateOptions make_options() {
  IntegrateOptions options;
  options.closure = Closure::kTable;
  return options;
}

LaneResults read_lanes(const std::vector<const PreparedCase*>& cases, const SamplePlan& plan) {
  std::vector<const EffectSettings*> sensors;
  sensors.reserve(cases.size());
  for (const PreparedCase* c : cases) sensors.push_back(&c->sensors);
  const ReadOut out(list_car_channels(), sensors);
  const Kernel& kernel = list_kernels().front();
  return simulate_readings(out, plan, [&](const SamplePlan& record) {
    return kernel.run_lanes(cases.data(), static_cast<int>(cases.size()), make_options(), record);
  });
}

TEST_CASE("Sensors change the readings of their own lane and channel, and no motion",
          "[unit][property][effects]") {
  const double late = 2e-3;
  const PreparedCase plain = test::prepare(make_case({}));
  const PreparedCase sensed =
      test::prepare(make_case({{"sensor_delay", "body_position_z", {late}},
                               {"sensor_gain", "imu_rate_y", {0.1}},
                               {"sensor_lowpass", "rear_left_damper_force", {3e-3}}}));
  CHECK(plain.sensors.empty());
  CHECK(sensed.sensors.size() == 3);
  const SamplePlan plan = test::make_plan(GENERATE(0.0, 0.03, 7e-4));
  const Kernel& kernel = list_kernels().front();
  if (kernel.lanes < 2) return;
  const LaneResults truth = read_lanes({&plain, &plain}, plan);
  const LaneResults run = read_lanes({&sensed, &plain}, plan);
  CHECK(run.final_state == truth.final_state);
  CHECK(run.event_time == truth.event_time);
  REQUIRE(run.history.size() == truth.history.size());
  const int corner = kRearLeft;
  const int force = C::get_corner_channel(corner, C::kDamperForce);
  const auto is_read = [=](int channel) {
    return channel == C::kBodyPositionZ || channel == C::kImuRateY || channel == force;
  };
  bool same = true, moved = run.sample_count == 0;
  for (int i = 0; i < run.sample_count; ++i) {
    for (int c = 0; c < C::kCount; ++c) {
      const double read = run.get_sample(i, c), was = truth.get_sample(i, c);
      same = same && run.get_sample(i, c, 1) == truth.get_sample(i, c, 1);
      if (!is_read(c)) same = same && read == was;
      if (is_read(c)) moved = moved || read != was;
    }
  }
  CHECK(same);
  CHECK(moved);
  const auto get = [&](const LaneResults& r, int channel, int lane) {
    const int at = channel * r.lanes + lane;
    return r.snapshot[static_cast<std::size_t>(at)];
  };
  for (int c = 0; c < C::kCount; ++c) {
    CHECK(get(run, c, 1) == get(truth, c, 1));
    if (!is_read(c)) CHECK(get(run, c, 0) == get(truth, c, 0));
  }
  CHECK(get(run, C::kImuRateY, 0) == 1.1 * get(truth, C::kImuRateY, 0));
  // Taylor series two milliseconds back; the next term has the jerk, about 1e3 m/s^3.
  const double before = get(truth, C::kBodyPositionZ, 0) - late * get(truth, C::kBodyVelocityZ, 0) +
                        0.5 * late * late * get(truth, C::kBodyAccelerationZ, 0);
  CHECK(std::fabs(get(run, C::kBodyPositionZ, 0) - before) < tolerance(2e-6));
  CHECK(std::fabs(get(run, C::kBodyPositionZ, 0) - get(truth, C::kBodyPositionZ, 0)) > 2e-5);
}

TEST_CASE("Runs of the reference integrator are read through sensors too", "[unit][effects]") {
  const PreparedCase plain = test::prepare(make_case({}));
  const PreparedCase late = test::prepare(make_case({{"sensor_delay", "pitch_rate", {3e-3}}}));
  const auto read = [](const PreparedCase& c, double interval) {
    const ReadOut out(list_car_channels(), {&c.sensors});
    return simulate_readings(out, test::make_plan(interval),
                             [&](const SamplePlan& record) { return run_cvode(c, {}, record); });
  };
  const LaneResults dense = read(plain, 1e-3), run = read(late, 0.05);
  REQUIRE(run.sample_count == 21);
  for (int i = 1; i <= 20; ++i) {
    CHECK(std::fabs(run.get_sample(i, C::kPitchRate) -
                    dense.get_sample(50 * i - 3, C::kPitchRate)) < tolerance(1e-8));
  }
}

ShardRows simulate(const Plan& plan, const std::vector<std::int64_t>& ids) {
  ShardRows rows = ShardRows::make(plan.make_schema(), ids.size());
  CaseSimulator simulator(plan, list_kernels().front());
  const std::atomic<bool> go_on{false};
  for (std::size_t i = 0; i < ids.size(); i += simulator.batch_size()) {
    const std::size_t count = std::min(simulator.batch_size(), ids.size() - i);
    REQUIRE(simulator.simulate(std::span(ids).subspan(i, count), rows, i, go_on));
  }
  return rows;
}

TEST_CASE("A shard holds the sensors' readings, independent of the other cases in its lanes",
          "[unit][property][effects]") {
  test::SweepText text;
  text.grid = "front_stiffness = { from = 40000, to = 36000, count = 2 }\n";
  const std::string history = "history = { rate = 50, channels = [\"pitch_rate\"] }";
  text.history = GENERATE_COPY(std::string(), history);
  text.sample = "strata = 2\n";
  const test::PlannedSweep plain(text);
  text.grid +=
      "body_position_z_sensor_delay = { from = 0.0, to = 4e-3, count = 2 }\n"
      "pitch_rate_sensor_gain = { from = 0.0, to = 0.25, count = 2 }\n";
  const test::PlannedSweep sweep(text);
  std::vector<std::int64_t> ids(8);
  std::iota(ids.begin(), ids.end(), 0);
  const ShardRows raw = simulate(plain.plan(), {0, 1}), rows = simulate(sweep.plan(), ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    INFO(i);
    CHECK(calc_row_hash(rows, i) == calc_row_hash(simulate(sweep.plan(), {ids[i]}), 0));
    const double* read = &rows.snapshot[3 * i];
    const double* was = &raw.snapshot[3 * (i / 4)];
    const bool late = rows.parameters[3 * i + 1] > 0.0, loud = rows.parameters[3 * i + 2] > 0.0;
    CHECK((read[0] == was[0]) == !late);
    CHECK(read[1] == was[1]);
    CHECK(read[2] == (loud ? 1.25 : 1.0) * was[2]);
    const std::size_t samples = raw.history.empty() ? 0 : raw.history[0].size() / 2;
    for (std::size_t k = 0; k < samples; ++k) {
      CHECK(rows.history[0][samples * i + k] ==
            (loud ? 1.25 : 1.0) * raw.history[0][samples * (i / 4) + k]);
    }
  }
}

}  // namespace
}  // namespace strut
