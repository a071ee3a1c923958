// The generator's sensors: noise, clocks, faults.
#include "tests/hidden/sensor.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <map>
#include <vector>

#include "tests/support/tolerance.h"

namespace strut::hidden {
namespace {

using test::tolerance;

constexpr double kTwoPi = 6.28318530717958647692;

Signal make_wave(double frequency, double amplitude) {
  Signal s{-0.1, 5e-4, {}};
  s.value.reserve(21000);
  for (int i = 0; i < 21000; ++i) {
    s.value.push_back(amplitude * std::sin(kTwoPi * frequency * (s.begin + s.spacing * i)));
  }
  return s;
}

std::vector<double> make_stamps() {
  std::vector<double> stamps;
  stamps.reserve(5000);
  for (int i = 0; i < 5000; ++i) stamps.push_back(0.002 * i);
  return stamps;
}

}  // namespace

TEST_CASE("Hidden data: a sensor's noise has its data sheet's size and no memory",
          "[statistical]") {
  Sensor sensor;
  sensor.channel = "a";
  sensor.noise = 0.02;
  const auto x = read_sensor(sensor, make_wave(1.0, 0.0), {}, make_stamps(), 0.3, 5, "run");
  double mean = 0.0, square = 0.0, next = 0.0;
  for (const double v : x) mean += v / 5000.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    square += std::pow(x[i] - mean, 2) / 5000.0;
    if (i > 0) next += (x[i] - mean) * (x[i - 1] - mean) / 5000.0;
  }
  // Four standard errors of 5000 draws.
  CHECK(mean == Approx(0.3).margin(tolerance(4.0 * 0.02 / std::sqrt(5000.0))));
  CHECK(std::sqrt(square) == Approx(0.02).epsilon(tolerance(0.04)));
  CHECK(std::fabs(next / square) < tolerance(0.06));
}

TEST_CASE("Hidden data: drift is 1/f noise of the stated size, hum a line of the mains",
          "[statistical]") {
  Sensor sensor;
  sensor.channel = "a";
  sensor.noise = 0.01;
  sensor.drift = 0.5;
  const Signal zero = make_wave(1.0, 0.0);
  const std::vector<double> stamps = make_stamps();
  const auto read = [&](std::uint64_t seed) {
    return read_sensor(sensor, zero, {}, stamps, 0.0, seed, "run");
  };
  Sensor white = sensor;
  white.drift = 0.0;
  // Octaves from 1 Hz on: 1/f has the same power in each.
  std::map<int, double> octave;
  double square = 0.0;
  constexpr int kDraws = 20;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    std::vector<double> drift = read(seed);
    const std::vector<double> noise = read_sensor(white, zero, {}, stamps, 0.0, seed, "run");
    for (std::size_t i = 0; i < drift.size(); ++i) {
      drift[i] -= noise[i];
      square += drift[i] * drift[i] / (kDraws * 5000.0);
    }
    for (int k = 10; k < 320; ++k) {  // 1 to 32 Hz
      std::complex<double> sum;
      for (std::size_t i = 0; i < drift.size(); ++i) {
        sum += drift[i] * std::polar(1.0, -kTwoPi * k * static_cast<double>(i) / 5000.0);
      }
      octave[static_cast<int>(std::log2(0.1 * k))] += std::norm(sum);
    }
  }
  // Twenty draws of a drift that is hardly renewed within a record: 15 %.
  CHECK(std::sqrt(square) == Approx(0.5 * 0.01).epsilon(tolerance(0.15)));
  for (int k = 1; k < 5; ++k) CHECK(octave[k] == Approx(octave[0]).epsilon(tolerance(0.3)));

  // The spectrum that the grader takes is that of the readings: 1 to 32 Hz of both.
  double expected = 0.0, measured = 0.0;
  for (int k = 10; k < 320; ++k) expected += calc_drift_spectrum(sensor, 0.1 * k, 500.0);
  for (const auto& [number, power] : octave) measured += power / (kDraws * 5000.0 * 1e-4);
  CHECK(measured == Approx(expected).epsilon(tolerance(0.15)));

  sensor.drift = 0.0;
  sensor.hum = 2.0;
  const std::vector<double> hum = read(1);
  std::complex<double> line;
  for (std::size_t i = 0; i < hum.size(); ++i) {
    line += hum[i] * std::polar(1.0, -kTwoPi * 50.0 * stamps[i]);
  }
  // Amplitude 2 |line| / n; its rms.
  CHECK(std::sqrt(2.0) * std::abs(line) / 5000.0 == Approx(0.02).epsilon(tolerance(0.05)));
}

TEST_CASE("Hidden data: readings are whole steps within the range and in the file's unit",
          "[unit]") {
  Sensor sensor;
  sensor.unit_scale = 1e-3;
  sensor.quantum = 5e-5;
  sensor.range = 0.02;
  for (const double v :
       read_sensor(sensor, make_wave(2.0, 0.05), {}, make_stamps(), 0.0, 5, "run")) {
    REQUIRE(std::fabs(v) <= 20.0 + 1e-9);
    REQUIRE(std::fabs(v / 0.05 - std::nearbyint(v / 0.05)) < 1e-6);
  }
}

TEST_CASE("Hidden data: a late and drifting clock shifts what is read", "[unit]") {
  const Clock clock{0.003, 1e-3, 0.0};
  const auto stamps = make_stamps();
  const auto x = read_sensor({}, make_wave(2.0, 1.0), clock, stamps, 0.0, 5, "run");
  for (std::size_t i = 0; i < x.size(); i += 97) {
    const double t = 1.001 * stamps[i] + 0.003;
    REQUIRE(x[i] == Approx(std::sin(2.0 * kTwoPi * t)).margin(tolerance(1e-6)));
  }
}

TEST_CASE("Hidden data: a low-pass and a delay do to a sine what their formulas say",
          "[reference]") {
  const double w = kTwoPi * 20.0, time = 4e-3;
  const Signal wave = make_wave(20.0, 1.0);
  const Signal smooth = distort(wave, {Fault::kSensorLowpass, 0, time});
  const Signal late = distort(wave, {Fault::kSensorDelay, 0, time});
  const Signal cut = distort(wave, {Fault::kSaturation, 0, 0.4, 1.0});
  for (std::size_t i = 2000; i < wave.value.size() - 10; i += 101) {
    const double t = wave.begin + wave.spacing * static_cast<double>(i);
    const double filtered = std::sin(w * t - std::atan(w * time)) / std::hypot(1.0, w * time);
    // Linear between samples 0.5 ms apart: w^2 h^2 / 12.
    REQUIRE(smooth.value[i] == Approx(filtered).margin(tolerance(5e-4)));
    REQUIRE(late.value[i] == Approx(std::sin(w * (t - time))).margin(tolerance(1e-4)));
    REQUIRE(std::fabs(cut.value[i]) <= 0.6);
  }
}

}  // namespace strut::hidden
