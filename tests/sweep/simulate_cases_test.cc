// Simulating cases into rows: grouping, failures, retries.
#include "sweep/simulate_cases.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>

#include "model/sensor/read_out.h"
#include "tests/support/test_car.h"
#include "tests/support/test_sweep.h"

namespace strut {
namespace {

using test::PlannedSweep;
using test::SweepText;
using test::tolerance;

const std::atomic<bool> kGoOn{false};

ShardRows simulate(const Plan& plan, const std::vector<std::int64_t>& ids) {
  ShardRows rows = ShardRows::make(plan.make_schema(), ids.size());
  CaseSimulator simulator(plan, list_kernels().front());
  for (std::size_t i = 0; i < ids.size(); i += simulator.batch_size()) {
    const std::size_t count = std::min(simulator.batch_size(), ids.size() - i);
    REQUIRE(simulator.simulate(std::span(ids).subspan(i, count), rows, i, kGoOn));
  }
  return rows;
}

std::vector<std::int64_t> list_ids(std::int64_t count) {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(count));
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

/// The last value of two axes fails: a damper too stiff for the step, a spring that cannot carry
/// the car.
SweepText make_troubled() {
  SweepText text;
  text.grid =
      "front_damping = { from = 2000, to = 98000, step = 96000 }\n"
      "rear_stiffness = { from = 35000, to = 2000, count = 2 }\n"
      "rear_damping = { from = 1980, to = 1800, count = 4 }\n";
  text.sample = "strata = 2\n";
  return text;
}

std::int32_t as_int(RunStatus status) { return static_cast<std::int32_t>(status); }

TEST_CASE("A case's row depends neither on its neighbors nor on its lane", "[unit][property]") {
  const PlannedSweep sweep;
  std::vector<std::int64_t> ids = list_ids(sweep.plan().case_count());
  const ShardRows forward = simulate(sweep.plan(), ids);
  std::reverse(ids.begin(), ids.end());
  const ShardRows backward = simulate(sweep.plan(), ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const ShardRows alone = simulate(sweep.plan(), {ids[i]});
    CHECK(calc_row_hash(alone, 0) == calc_row_hash(backward, i));
    CHECK(calc_row_hash(alone, 0) == calc_row_hash(forward, ids.size() - 1 - i));
  }
}

TEST_CASE("A row holds the snapshot of its own case", "[unit][reference]") {
  const PlannedSweep sweep;
  const std::vector<std::int64_t> ids = {0, 13, 26};
  const ShardRows rows = simulate(sweep.plan(), ids);
  const std::vector<int>& channels = sweep.plan().request().snapshot.channels;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const LaneResults truth = run_cvode(test::prepare(sweep.plan().make_case(ids[i])), {}, {});
    CHECK(rows.status[i] == 0);
    // Steps of 2 ms: about 1e-4 of the motion.
    CHECK(rows.event_time[i] == Approx(truth.event_time[0]).epsilon(tolerance(1e-5)));
    for (std::size_t s = 0; s < channels.size(); ++s) {
      const double expected = truth.snapshot[static_cast<std::size_t>(channels[s])];
      CHECK(rows.snapshot[i * channels.size() + s] == Approx(expected).epsilon(tolerance(2e-3)));
    }
  }
  CHECK(rows.snapshot[0] != rows.snapshot[channels.size()]);
}

TEST_CASE("A failed case has a reason and a time, and disturbs no neighbor", "[unit]") {
  const PlannedSweep sweep(make_troubled());
  const Plan& plan = sweep.plan();
  const std::vector<std::int64_t> ids = list_ids(plan.case_count());
  const ShardRows rows = simulate(plan, ids);
  std::map<std::int32_t, int> seen;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double damping = rows.parameters[3 * i], stiffness = rows.parameters[3 * i + 1];
    ++seen[rows.status[i]];
    INFO("damping " << damping << ", stiffness " << stiffness << ": " << rows.reason[i]);
    if (stiffness < 10000.0) {
      CHECK(rows.status[i] == as_int(RunStatus::kNoEquilibrium));
      CHECK_THAT(rows.reason[i], Catch::Matchers::Contains("cannot carry"));
      CHECK(rows.failure_time[i] == 0.0);
      CHECK(std::isnan(rows.snapshot[3 * i]));
      continue;
    }
    CHECK(rows.status[i] == 0);
    CHECK(rows.reason[i].empty());
    CHECK(rows.attempt[i] == (damping > 50000.0 ? 1 : 0));
    CHECK(std::isfinite(rows.snapshot[3 * i]));
    CHECK(calc_row_hash(simulate(plan, {ids[i]}), 0) == calc_row_hash(rows, i));
  }
  CHECK(seen[as_int(RunStatus::kNoEquilibrium)] > 0);
  CHECK(seen[0] > 2);
}

TEST_CASE("A retry is as accurate as its quarter of the step", "[unit][reference]") {
  SweepText text = make_troubled();
  text.integrate = "method = \"rk4\"\nstep = 2e-3\nclosure = \"newton\"\n";
  const PlannedSweep sweep(text);
  const std::int64_t id = 8;  // stiff damper, sound spring
  const ShardRows rows = simulate(sweep.plan(), {id});
  REQUIRE(rows.parameters[0] > 50000.0);
  REQUIRE(rows.attempt[0] == 1);
  const LaneResults truth = run_cvode(test::prepare(sweep.plan().make_case(id)), {}, {});
  const double expected = truth.snapshot[CarChannel::kBodyPositionZ];
  CHECK(rows.snapshot[0] == Approx(expected).epsilon(tolerance(1e-6)));
}

TEST_CASE("A car that never meets the bump has the status no_event", "[unit]") {
  SweepText text;
  text.grid = "speed = { from = 20, to = 2, step = -18 }\n";
  text.sample = "strata = 2\n";
  const PlannedSweep sweep(text);
  const ShardRows rows = simulate(sweep.plan(), {0, 1});
  CHECK(rows.status[0] == 0);
  CHECK(rows.status[1] == as_int(RunStatus::kNoEvent));
  CHECK(std::isnan(rows.event_time[1]));
  CHECK(rows.failure_time[1] == 3.0);
}

TEST_CASE("A run that ends at its snapshot has the same bits as one to its duration", "[unit]") {
  SweepText text;
  // Slower cars meet the bump later, so lanes end one by one.
  text.grid =
      "speed = { from = 12, to = 20, step = 2 }\n"
      "front_damping = { from = 1500, to = 2000, step = 500 }\n";
  text.sample = "strata = 2\n";
  const PlannedSweep brief(text);
  text.history = "history = { rate = 1, channels = [\"time\"] }";
  const PlannedSweep whole(text);
  REQUIRE(ends_at_snapshot(brief.plan().request()));
  REQUIRE_FALSE(ends_at_snapshot(whole.plan().request()));
  const std::vector<std::int64_t> ids = list_ids(brief.plan().case_count());
  const ShardRows ended = simulate(brief.plan(), ids), run_on = simulate(whole.plan(), ids);
  CHECK(ended.snapshot == run_on.snapshot);
  CHECK(ended.event_time == run_on.event_time);
  CHECK(ended.status == run_on.status);

  SECTION("in less than half the work") {
    const PreparedCase c = test::prepare(brief.plan().make_case(0));
    SamplePlan plan;
    const IntegrateOptions options;
    const LaneResults all = list_kernels().front().run_scalar(c, options, plan);
    plan.until_snapshot = true;
    const LaneResults part = list_kernels().front().run_scalar(c, options, plan);
    CHECK(part.get_event_time() == all.get_event_time());
    CHECK(2 * part.derivative_count < all.derivative_count);
    const LaneResults reference = run_cvode(c, {}, plan);
    plan.until_snapshot = false;
    const LaneResults reference_all = run_cvode(c, {}, plan);
    CHECK(reference.snapshot == reference_all.snapshot);
    CHECK(2 * reference.derivative_count < reference_all.derivative_count);
  }
}

TEST_CASE("A sensor with memory reads the snapshot of a run that goes on", "[unit]") {
  SamplePlan requested;
  const PreparedCase c = test::prepare(PlannedSweep().plan().make_case(0));
  LaneResults read[2];
  for (const bool until : {false, true}) {
    requested.until_snapshot = until;
    const EffectSettings delayed = {{"sensor_delay", "body_acceleration_z", {0.01}}};
    const ReadOut out(list_car_channels(), {&delayed});
    read[until ? 1 : 0] = simulate_readings(out, requested, [&](const SamplePlan& plan) {
      return list_kernels().front().run_scalar(c, {}, plan);
    });
  }
  CHECK(read[0].get_snapshot(CarChannel::kBodyAccelerationZ) ==
        read[1].get_snapshot(CarChannel::kBodyAccelerationZ));
}

TEST_CASE("Histories hold every sample of their channel", "[unit]") {
  SweepText text;
  text.history = "history = { rate = 100, channels = [\"time\", \"pitch_rate\"] }";
  const PlannedSweep sweep(text);
  const ShardRows rows = simulate(sweep.plan(), {3, 4});
  REQUIRE(rows.history.size() == 2);
  REQUIRE(rows.history[0].size() == 2 * 301);
  for (std::size_t i = 0; i < 301; ++i) {
    CHECK(rows.history[0][301 + i] == Approx(0.01 * static_cast<double>(i)).margin(1e-12));
  }
  SamplePlan plan;
  plan.interval = 0.01;
  const LaneResults truth = run_cvode(test::prepare(sweep.plan().make_case(4)), {}, plan);
  double worst = 0.0;
  for (std::size_t i = 0; i < 301; ++i) {
    const double expected = truth.history[i * CarChannel::kCount + CarChannel::kPitchRate];
    worst = std::max(worst, std::abs(rows.history[1][301 + i] - expected));
  }
  CHECK(worst < tolerance(1e-3));  // rad/s, of about 0.4: steps of 2 ms
}

TEST_CASE("CVODE as a sweep's solver gives the reference solution itself", "[unit][reference]") {
  SweepText text;
  text.integrate = "method = \"cvode\"\n";
  const PlannedSweep sweep(text);
  const ShardRows rows = simulate(sweep.plan(), {5});
  const LaneResults truth = run_cvode(test::prepare(sweep.plan().make_case(5)), {}, {});
  CHECK(rows.snapshot[0] == truth.snapshot[CarChannel::kBodyPositionZ]);
  CHECK(rows.event_time[0] == truth.event_time[0]);
}

}  // namespace
}  // namespace strut
