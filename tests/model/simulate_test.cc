// Lockstep runs against closed forms: events, trigger, samples, lanes that fail or finish.

#include "model/integrate/simulate.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "base/math/xsimd_backend.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

constexpr double kKinks[] = {0.4137, 1.1391};  // m, where the force on y jumps
constexpr double kForce[] = {0.0, 1.0, -2.0};  // by stretch of road
constexpr double kTriggerPlace = 0.9071;       // m, far from both

/// Oscillator x'' = -x (x > 0), -4 x (x < 0), from x = 0 with speed v; a cart at place s with
/// s' = speed (1 + 0.3 sin t); y' = -y + force of the stretch the cart is on; z' = growth z^2.
template <class T>
struct KinkedSystem {
  static constexpr int kCapacity = 5;
  enum : int { kX, kV, kS, kY, kZ };
  T speed, growth;
  double trigger_place = kTriggerPlace;
  T segment = T(0.0);
  T x_now{}, s_now{}, z_now{}, t_now{};
  /// Times [s] at which lane 0 crossed a guard.
  std::vector<double> crossed{};

  int size() const { return kCapacity; }
  int stiff_at(int /*i*/) const { return 0; }
  int stiff_count() const { return 0; }

  void calc_derivative(const T& t, const T* x, T* dx, T* /*decay*/) {
    t_now = t;
    x_now = x[kX];
    s_now = x[kS];
    z_now = x[kZ];
    const T force = select(segment < T(0.5), T(kForce[0]),
                           select(segment < T(1.5), T(kForce[1]), T(kForce[2])));
    dx[kX] = x[kV];
    dx[kV] = select(x[kX] > T(0.0), -x[kX], T(-4.0) * x[kX]);
    dx[kS] = speed * (T(1.0) + T(0.3) * sin(t));
    dx[kY] = force - x[kY];
    dx[kZ] = growth * x[kZ] * x[kZ];
  }
  int guard_count() const { return 2; }
  void get_guards(T* g) const {
    const T end =
        select(segment < T(0.5), T(kKinks[0]), select(segment < T(1.5), T(kKinks[1]), T(1e300)));
    g[0] = x_now;
    g[1] = s_now - end;
  }
  void calc_guards(const T& /*t*/, const T* x, T* g) {
    x_now = x[kX];
    s_now = x[kS];
    get_guards(g);
  }
  bool cross(int guard, MaskOf<T> lanes) {
    if (get_mask_lane(lanes, 0)) crossed.push_back(get_lane(t_now, 0));
    if (guard == 0) return false;
    segment = select(lanes, segment + T(1.0), segment);
    return true;
  }
  T get_trigger() const { return s_now - T(trigger_place); }
  MaskOf<T> has_failed() const { return !(abs(z_now) < T(1e3)); }
  RunStatus get_failure(int) const { return RunStatus::kDiverged; }
  void observe(const T& t, const T* x, T* out) const {
    for (int i = 0; i < kCapacity; ++i) out[i] = x[i];
    out[kCapacity] = t;
  }
};

constexpr int kChannels = 6;
using Values = std::array<double, 5>;

/// Time at which the cart is at `place`, s = speed (t + 0.3 (1 - cos t)), by bisection.
double find_time_at(double place, double speed) {
  double low = 0.0, high = place / speed;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.5 * (low + high);
    (speed * (t + 0.3 * (1.0 - std::cos(t))) < place ? low : high) = t;
  }
  return 0.5 * (low + high);
}

Values calc_exact(double t, double speed) {
  Values x{};
  const double period = 1.5 * M_PI, phase = std::fmod(t, period);
  const bool upper = phase < M_PI;
  x[0] = upper ? std::sin(phase) : -0.5 * std::sin(2.0 * (phase - M_PI));
  x[1] = upper ? std::cos(phase) : -std::cos(2.0 * (phase - M_PI));
  x[2] = speed * (t + 0.3 * (1.0 - std::cos(t)));
  double begin = 0.0, y = 0.5;
  for (int stretch = 0; stretch < 3; ++stretch) {
    const double end = stretch < 2 ? find_time_at(kKinks[stretch], speed) : 1e300;
    y = kForce[stretch] + (y - kForce[stretch]) * std::exp(-(std::min(t, end) - begin));
    if (t <= end) break;
    begin = end;
  }
  x[3] = y;
  x[4] = 0.0;
  return x;
}

template <class T>
struct Run {
  LaneResults results;
  std::vector<double> crossed;
};

/// `speed` may differ from lane to lane, `growth` too; z starts at 1 where growth is not zero.
template <class T>
Run<T> simulate(const T& speed, const T& growth, const StepOptions& options, double duration,
                double interval = 0.0, double trigger_place = kTriggerPlace) {
  KinkedSystem<T> system{speed, growth, trigger_place};
  SamplePlan plan;
  plan.duration = duration;
  plan.interval = interval;
  plan.channel_count = kChannels;
  const std::array<T, 5> start{T(0.0), T(1.0), T(0.0), T(0.5),
                               select(growth > T(0.0), T(1.0), T(0.0))};
  LaneResults results = Simulation<T, KinkedSystem<T>>(system, options, plan).run(start);
  return {std::move(results), system.crossed};
}

constexpr double kSpeed = 0.2;
constexpr double kEnd = 6.0;  // s: three zeros of the oscillator, both kinks

double calc_final_error(Stepper stepper, double step, bool locate) {
  const auto run = simulate<double>(kSpeed, 0.0, {stepper, step, locate}, kEnd);
  const Values exact = calc_exact(kEnd, kSpeed);
  double worst = 0.0;
  for (int i = 0; i < 5; ++i) {
    worst = std::max(worst, std::abs(run.results.final_state[static_cast<std::size_t>(i)] -
                                     exact[static_cast<std::size_t>(i)]));
  }
  return worst;
}

TEST_CASE("Steps that end at events keep order four across kinks", "[unit][property]") {
  for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
    const double coarse = calc_final_error(stepper, 0.02, true);
    const double fine = calc_final_error(stepper, 0.005, true);
    const double order = 0.5 * std::log2(coarse / fine);
    INFO("errors " << coarse << ", " << fine << ", order " << order);
    CHECK(order > 4.0 - tolerance(0.3));  // where a step meets a kink moves with its length
    CHECK(fine < tolerance(1e-8));
  }
}

TEST_CASE("Steps across kinks lose order four", "[unit][property]") {
  for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
    // Left out events cost an error of the step length times the jump; located ones none.
    const double located = calc_final_error(stepper, 0.005, true);
    const double crossed = calc_final_error(stepper, 0.005, false);
    INFO("located " << located << ", not located " << crossed);
    CHECK(crossed > 1e4 * located);
    CHECK(crossed > 1e-5);
  }
}

TEST_CASE("Events are located to a nanosecond", "[unit]") {
  const auto run = simulate<double>(kSpeed, 0.0, {Stepper::kRk4, 1e-3, true}, kEnd);
  std::vector<double> expected{M_PI, 1.5 * M_PI, find_time_at(kKinks[0], kSpeed),
                               find_time_at(kKinks[1], kSpeed)};
  std::sort(expected.begin(), expected.end());
  REQUIRE(run.crossed.size() == expected.size());
  CHECK(run.results.event_count == static_cast<long>(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO("event at " << expected[i] << ", error " << run.crossed[i] - expected[i]);
    CHECK(std::abs(run.crossed[i] - expected[i]) < tolerance(1e-9));
  }
}

/// Both wheels of an axle as they leave a bump, equal but for rounding: the load of each, which the
/// damper had drawn below zero, is above it once more for 50 us, from s = 10 m on.
struct LeavingAxle {
  static constexpr int kCapacity = 1;
  static constexpr double kSpeed = 20.0, kPlace = 10.0;                    // m/s, m
  static constexpr double kSlope = 1.35e5, kLength = 1e-3;                 // N/m, m
  static constexpr std::array<double, 2> kRounding = {-1.5e-11, 8.7e-12};  // N
  double s_now = 0.0;

  int size() const { return kCapacity; }
  int stiff_at(int /*i*/) const { return 0; }
  int stiff_count() const { return 0; }
  void calc_derivative(double /*t*/, const double* x, double* dx, double* /*decay*/) {
    s_now = x[0];
    dx[0] = kSpeed;
  }
  int guard_count() const { return 2; }
  void get_guards(double* g) const {
    const double u = s_now - kPlace;
    for (std::size_t i = 0; i < 2; ++i) g[i] = kSlope * u * (1.0 - u / kLength) + kRounding[i];
  }
  void calc_guards(double /*t*/, const double* x, double* g) {
    s_now = x[0];
    get_guards(g);
  }
  bool cross(int /*guard*/, bool /*lanes*/) { return false; }
  double get_trigger() const { return 1.0; }
  bool has_failed() const { return false; }
  RunStatus get_failure(int /*lane*/) const { return RunStatus::kDiverged; }
  void observe(double /*t*/, const double* /*x*/, double* /*out*/) const {}
};

TEST_CASE("Two wheels that cross within rounding do not stop time", "[unit][regression]") {
  LeavingAxle axle;
  SamplePlan plan;
  plan.duration = 0.01;
  const LaneResults results =
      Simulation<double, LeavingAxle>(axle, {Stepper::kRk4, 1e-3}, plan).run({LeavingAxle::kPlace});
  CHECK(results.status[0] == static_cast<int>(RunStatus::kDone));
  CHECK(std::abs(results.final_state[0] - 10.2) < tolerance(1e-12));
  CHECK(results.event_count < 10);
}

TEST_CASE("The trigger is located to a nanosecond, with the state there", "[unit]") {
  for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
    const auto run = simulate<double>(kSpeed, 0.0, {stepper, 2e-3, true}, kEnd);
    const double time = find_time_at(kTriggerPlace, kSpeed);
    CHECK(std::abs(run.results.event_time[0] - time) < tolerance(1e-9));
    const Values exact = calc_exact(time, kSpeed);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::abs(run.results.snapshot[i] - exact[i]) < tolerance(1e-9));
    }
    CHECK(run.results.snapshot[5] == run.results.event_time[0]);
  }
}

TEST_CASE("A trigger in the step that ends at a kink is met before the kink", "[unit]") {
  const double place = kKinks[0] - 1e-4;  // half a millisecond before
  const auto run = simulate<double>(kSpeed, 0.0, {Stepper::kRk4, 4e-3, true}, kEnd, 0.0, place);
  const double time = find_time_at(place, kSpeed);
  CHECK(std::abs(run.results.event_time[0] - time) < tolerance(1e-9));
  CHECK(std::abs(run.results.snapshot[3] - calc_exact(time, kSpeed)[3]) < tolerance(1e-9));
}

TEST_CASE("A trigger that is never reached leaves no snapshot", "[unit]") {
  const auto run = simulate<double>(kSpeed, 0.0, {}, 0.5);
  CHECK(std::isnan(run.results.event_time[0]));
  CHECK(std::isnan(run.results.snapshot[0]));
}

TEST_CASE("Samples lie on their grid and on the closed form", "[unit]") {
  constexpr double kInterval = 1e-3;
  const auto run = simulate<double>(kSpeed, 0.0, {Stepper::kRk4, 4e-3, true}, kEnd, kInterval);
  REQUIRE(run.results.sample_count == 6001);
  double worst_time = 0.0, worst = 0.0, worst_at = 0.0;
  for (int sample = 0; sample < run.results.sample_count; ++sample) {
    const double t = kInterval * sample;
    const Values exact = calc_exact(t, kSpeed);
    const double* row =
        run.results.history.data() + static_cast<std::ptrdiff_t>(sample) * kChannels;
    worst_time = std::max(worst_time, std::abs(row[5] - t));
    for (std::size_t i = 0; i < 4; ++i) {
      const double error = std::abs(row[i] - exact[i]);
      if (error > worst) worst = error, worst_at = t;
    }
  }
  INFO("worst error " << worst << " at t = " << worst_at);
  CHECK(worst_time < tolerance(1e-12));
  // Cubic Hermite interpolation: h^4 / 384 times a fourth derivative of up to 16.
  CHECK(worst < tolerance(1e-10));
}

constexpr int kLanes = kLaneCount<NativeLanes>;

NativeLanes make_speeds() {
  NativeLanes speed(0.0);
  for (int lane = 0; lane < kLanes; ++lane) set_lane(speed, lane, kSpeed * (1.0 + 0.37 * lane));
  return speed;
}

TEST_CASE("Every lane has its own events and ends on time", "[unit]") {
  const NativeLanes speed = make_speeds();
  for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
    const StepOptions options{stepper, 2e-3, true};
    const auto lanes = simulate<NativeLanes>(speed, NativeLanes(0.0), options, kEnd, 0.01);
    for (int lane = 0; lane < kLanes; ++lane) {
      const double own = get_lane(speed, lane);
      const auto twin = simulate<double>(own, 0.0, options, kEnd, 0.01).results;
      const auto at = static_cast<std::size_t>(lane);
      // Rounding only: sines of lanes and of libm differ in the last place.
      CHECK(std::abs(lanes.results.event_time[at] - twin.event_time[0]) < tolerance(1e-12));
      CHECK(lanes.results.status[at] == 0);
      for (std::size_t i = 0; i < 5; ++i) {
        CHECK(std::abs(lanes.results.final_state[i * kLanes + at] - twin.final_state[i]) <
              tolerance(1e-12));
      }
      for (std::size_t i = 0; i < twin.history.size(); ++i) {
        CHECK_FALSE(!(std::abs(lanes.results.history[i * kLanes + at] - twin.history[i]) <
                      tolerance(1e-12)));
      }
    }
  }
}

/// Every bit of a lane's results.
std::vector<double> get_lane_results(const LaneResults& results, std::size_t lane) {
  std::vector<double> all{results.event_time[lane], results.failure_time[lane],
                          static_cast<double>(results.status[lane])};
  for (const auto* list : {&results.snapshot, &results.history, &results.final_state}) {
    for (std::size_t i = lane; i < list->size(); i += kLanes) all.push_back((*list)[i]);
  }
  return all;
}

TEST_CASE("A lane that diverges is retired and its neighbors keep every bit", "[unit]") {
  const NativeLanes speed = make_speeds();
  constexpr int kSick = kLanes - 1;
  NativeLanes growth(0.0);
  set_lane(growth, kSick, 1.0);  // z = 1 / (1 - t) passes 1000 at t = 0.999
  for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
    const StepOptions options{stepper, 1e-3, true};
    const auto healthy =
        simulate<NativeLanes>(speed, NativeLanes(0.0), options, kEnd, 0.01).results;
    const auto mixed = simulate<NativeLanes>(speed, growth, options, kEnd, 0.01).results;
    CHECK(mixed.status[kSick] == static_cast<int>(RunStatus::kDiverged));
    // Some steps of the explicit formula while z grows tenfold a step.
    CHECK(std::abs(mixed.failure_time[kSick] - 0.999) < tolerance(0.005));
    CHECK(std::isnan(mixed.event_time[kSick]));
    CHECK(std::isnan(mixed.history.back()));
    const double last_good = mixed.final_state[4 * kLanes + kSick];
    CHECK(last_good < 1e3);
    CHECK(last_good > 1e2);
    for (std::size_t lane = 0; lane < kSick; ++lane) {
      const auto a = get_lane_results(healthy, lane), b = get_lane_results(mixed, lane);
      REQUIRE(a.size() == b.size());
      CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
    }
  }
}

TEST_CASE("A lane that has failed before the start does not move", "[unit]") {
  KinkedSystem<double> system{kSpeed, 1.0};
  SamplePlan plan;
  plan.channel_count = kChannels;
  plan.interval = 0.1;
  const auto results = Simulation<double, KinkedSystem<double>>(system, {}, plan)
                           .run({0.0, 1.0, 0.0, 0.5, std::nan("")});
  CHECK(results.status[0] == static_cast<int>(RunStatus::kDiverged));
  CHECK(results.failure_time[0] == 0.0);
  CHECK(results.final_state[1] == 1.0);
}

}  // namespace
}  // namespace strut
