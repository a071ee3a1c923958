// Inputs over time: interpolation against the functions that were sampled.
#include "model/scenario/input_signal.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/math/xsimd_backend.h"

namespace strut {
namespace {

using Samples = std::vector<double>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Samples sample(const Samples& times, const std::function<double(double)>& f) {
  Samples values;
  for (const double t : times) values.push_back(f(t));
  return values;
}

/// Uneven times on [0, 1], neighboring intervals 1 : 3.
Samples make_uneven_times(int pairs) {
  Samples times = {0.0};
  for (int i = 0; i < pairs; ++i) {
    times.push_back((i + 0.25) / pairs);
    times.push_back((i + 1.0) / pairs);
  }
  return times;
}

struct LargestError {
  double value = 0.0, rate = 0.0, second_rate = 0.0;
};

LargestError measure_sine_error(int pairs) {
  const double w = 5.0;
  const Samples times = make_uneven_times(pairs);
  const InputSignal signal = make_signal(
      "x", times, sample(times, [&](double t) { return std::sin(w * t); }), Interpolation::kSpline);
  LargestError error;
  for (int i = 0; i <= 5000; ++i) {
    const double t = i / 5000.0;
    const SignalPoint<double> p = calc_signal(signal, t);
    error.value = std::max(error.value, std::fabs(p.value - std::sin(w * t)));
    error.rate = std::max(error.rate, std::fabs(p.rate - w * std::cos(w * t)));
    error.second_rate =
        std::max(error.second_rate, std::fabs(p.second_rate + w * w * std::sin(w * t)));
  }
  return error;
}

TEST_CASE("A spline through a cubic is the cubic", "[unit][input_signal]") {
  const auto cubic = [](double t) { return 1.0 + t * (-2.0 + t * (3.0 - 4.0 * t)); };
  for (const Samples& times : {make_uneven_times(4), Samples{0.0, 0.1, 0.5, 1.0}}) {
    const InputSignal signal =
        make_signal("x", times, sample(times, cubic), Interpolation::kSpline);
    for (int i = 0; i <= 100; ++i) {
      const double t = i / 100.0;
      const SignalPoint<double> p = calc_signal(signal, t);
      // Rounding of values near 1 divided by intervals of 0.0625 and their squares.
      CHECK(p.value == Approx(cubic(t)).margin(1e-14));
      CHECK(p.rate == Approx(-2.0 + 6.0 * t - 12.0 * t * t).margin(1e-13));
      CHECK(p.second_rate == Approx(6.0 - 24.0 * t).margin(1e-11));
    }
  }
}

TEST_CASE("Three samples make a parabola, two a line", "[unit][input_signal]") {
  const auto parabola = [](double t) { return 2.0 - t + 3.0 * t * t; };
  const Samples times = {0.0, 0.3, 1.0};
  const InputSignal three =
      make_signal("x", times, sample(times, parabola), Interpolation::kSpline);
  CHECK(calc_signal(three, 0.7).value == Approx(parabola(0.7)).epsilon(1e-14));
  const InputSignal two = make_signal("x", {0.0, 2.0}, {1.0, 5.0}, Interpolation::kSpline);
  CHECK(calc_signal(two, 0.5).value == Approx(2.0).epsilon(1e-15));
  CHECK(calc_signal(two, 0.5).rate == Approx(2.0).epsilon(1e-15));
}

TEST_CASE("A spline converges with order four up to its ends", "[property][input_signal]") {
  const LargestError coarse = measure_sine_error(20), fine = measure_sine_error(40);
  // h^4, h^3, h^2; 0.8 for the higher orders that 20 intervals still show.
  CHECK(std::log2(coarse.value / fine.value) > 4.0 - 0.2);
  CHECK(std::log2(coarse.rate / fine.rate) > 3.0 - 0.2);
  CHECK(std::log2(coarse.second_rate / fine.second_rate) > 2.0 - 0.2);
}

TEST_CASE("A linear signal connects its samples", "[unit][input_signal]") {
  const InputSignal signal =
      make_signal("x", {0.0, 1.0, 3.0}, {0.0, 2.0, -2.0}, Interpolation::kLinear);
  CHECK(calc_signal(signal, 0.5).value == 1.0);
  CHECK(calc_signal(signal, 0.5).rate == 2.0);
  CHECK(calc_signal(signal, 2.0).value == 0.0);
  CHECK(calc_signal(signal, 1.0).rate == -2.0);  // at a sample the interval after it counts
  CHECK(calc_signal(signal, 1.0).value == 2.0);
  CHECK(calc_signal(signal, 2.0).second_rate == 0.0);
}

TEST_CASE("Outside of its samples a signal rests at its end values", "[unit][input_signal]") {
  const Samples times = make_uneven_times(5);
  const auto wave = [](double t) { return std::cos(7.0 * t); };
  const InputSignal signal = make_signal("x", times, sample(times, wave), Interpolation::kSpline);
  for (const double t : {-kInfinity, -1.0, 2.0, kInfinity}) {
    const SignalPoint<double> p = calc_signal(signal, t);
    CHECK(p.value == Approx(wave(t < 0.0 ? 0.0 : 1.0)).epsilon(1e-14));
    CHECK(p.rate == 0.0);
    CHECK(p.second_rate == 0.0);
  }
}

TEST_CASE("Every time finds its interval, however uneven the samples", "[property][input_signal]") {
  // From 1 us to 1 s apart: far more than bins could resolve.
  Samples times = {0.0}, values = {0.0};
  for (int i = 1; i <= 60; ++i) {
    times.push_back(times.back() + std::pow(10.0, -6.0 + (i * 7 % 61) / 10.0));
    values.push_back(std::sin(3.0 * i));
  }
  const InputSignal signal = make_signal("x", times, values, Interpolation::kLinear);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double slope = (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
    CHECK(calc_signal(signal, times[i]).value == values[i]);
    CHECK(calc_signal(signal, times[i]).rate == slope);
    CHECK(calc_signal(signal, std::nextafter(times[i + 1], 0.0)).rate == slope);
  }
}

TEST_CASE("Lanes at different times read what double reads", "[property][input_signal]") {
  const Samples times = make_uneven_times(30);
  const InputSignal signal =
      make_signal("x", times, sample(times, [](double t) { return std::sin(20.0 * t); }),
                  Interpolation::kSpline);
  for (int i = -20; i < 120; ++i) {
    NativeLanes t(0.0);
    for (int lane = 0; lane < NativeLanes::kWidth; ++lane) {
      set_lane(t, lane, 0.0101 * i + 0.137 * lane);
    }
    const SignalPoint<NativeLanes> p = calc_signal(signal, t);
    for (int lane = 0; lane < NativeLanes::kWidth; ++lane) {
      const SignalPoint<double> scalar = calc_signal(signal, get_lane(t, lane));
      // The same operations; where the compiler contracts one of the two, a rounding.
      CHECK(get_lane(p.value, lane) == Approx(scalar.value).epsilon(1e-13).margin(1e-14));
      CHECK(get_lane(p.rate, lane) == Approx(scalar.rate).epsilon(1e-12).margin(1e-12));
      CHECK(get_lane(p.second_rate, lane) ==
            Approx(scalar.second_rate).epsilon(1e-10).margin(1e-10));
    }
  }
}

TEST_CASE("Made signals follow their formulas", "[unit][input_signal]") {
  const double turn = 2.0 * std::numbers::pi;
  const InputSignal chirp = make_chirp("x", 0.01, 1.0, 9.0, 4.0);
  const InputSignal bump = make_bump("x", 0.05, 1.0, 0.2);
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.004 * i, phase = turn * t * (1.0 + t), frequency = 1.0 + 2.0 * t;
    CHECK(calc_signal(chirp, t).value == Approx(0.01 * std::sin(phase)).margin(5e-8 * 0.01));
    // Hermite's rate: (2 pi / 128)^3 * sqrt(3) / 216 = 1e-6 of the largest.
    CHECK(calc_signal(chirp, t).rate ==
          Approx(0.01 * turn * frequency * std::cos(phase)).margin(2e-6 * 0.01 * turn * 9.0));
    const double part = std::min(std::max((t - 1.0) / 0.2, 0.0), 1.0);
    CHECK(calc_signal(bump, t).value ==
          Approx(0.025 * (1.0 - std::cos(turn * part))).margin(5e-8 * 0.05));
  }
  const InputSignal step = make_step("x", 2.0, 1.0, 0.5);
  CHECK(calc_signal(step, 0.9).value == 0.0);
  CHECK(calc_signal(step, 1.25).value == 1.0);
  CHECK(calc_signal(step, 1.25).rate == 4.0);
  CHECK(calc_signal(step, 7.0).value == 2.0);
}

TEST_CASE("Samples that make no signal are refused by name", "[unit][input_signal]") {
  const auto message = [](const Samples& times, const Samples& values) -> std::string {
    try {
      make_signal("road_position", times, values, Interpolation::kSpline);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  CHECK(message({0.0}, {1.0}) == "road_position: 1 samples: must be at least 2");
  CHECK(message({0.0, 1.0}, {1.0}) ==
        "road_position: 2 times and 1 values: the numbers must be equal");
  CHECK(message({0.0, 1.0, 1.0}, {1.0, 2.0, 3.0}) ==
        "road_position, sample 3: time = 1.000000 s: must be > 1.000000 s, the previous time");
  CHECK(message({0.0, 1.0}, {1.0, std::nan("")}) == "road_position, sample 2: must be finite");
}

TEST_CASE("The integral of a signal is exact for cubics, at uneven samples", "[unit]") {
  const std::vector<double> times = {0.0, 0.1, 0.25, 0.3, 0.55, 0.8, 1.0};
  std::vector<double> values, rates;
  for (const double t : times) {
    values.push_back(2.0 - t + 3.0 * t * t - 4.0 * t * t * t);
    rates.push_back(-1.0 + 6.0 * t - 12.0 * t * t);
  }
  const InputSignal sum = integrate_signal(make_signal("force", times, values, rates));
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    const SignalPoint<double> point = calc_signal(sum, t);
    CHECK(point.value == Approx(2.0 * t - t * t / 2.0 + t * t * t - t * t * t * t).margin(1e-14));
    CHECK(point.rate == Approx(values[i]).margin(1e-14));
  }
}

TEST_CASE("A correction scales a signal and adds a parabola", "[unit]") {
  InputSignal signal = make_chirp("force", 3.0, 0.5, 2.0, 2.0);
  const InputSignal recorded = signal;
  correct_signal(signal, {-1.5, {0.4, 2.0, -6.0}});
  for (double t = 0.0; t < 2.0; t += 0.037) {
    const SignalPoint<double> before = calc_signal(recorded, t), after = calc_signal(signal, t);
    CHECK(after.value == Approx(-1.5 * before.value + 0.4 + 2.0 * t - 3.0 * t * t).margin(1e-12));
    CHECK(after.rate == Approx(-1.5 * before.rate + 2.0 - 6.0 * t).margin(1e-10));
  }
}

}  // namespace
}  // namespace strut
