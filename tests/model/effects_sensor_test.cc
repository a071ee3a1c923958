// Readings of faulty sensors against closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "model/model.h"
#include "model/sensor/sensors.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

constexpr double kStep = 1e-3, kW = 2.0 * 3.14159265358979323846 * 5.0;

const ChannelInfo kRate{"imu_rate_y", "rad/s", ""}, kForce{"force", "N", ""};

std::vector<double> make_times() {
  std::vector<double> times;
  times.reserve(2001);
  for (int i = 0; i <= 2000; ++i) times.push_back(kStep * i);
  return times;
}

std::vector<double> make_sine() {
  std::vector<double> values = make_times();
  for (double& v : values) v = std::sin(kW * v);
  return values;
}

std::vector<double> read(const EffectSettings& settings) {
  return read_sensor(settings, kRate, kStep, make_sine());
}

TEST_CASE("A sensor without effects reads the channel bit for bit", "[unit][effects]") {
  CHECK(read({}) == make_sine());
  CHECK(read({{"sensor_gain", "imu_rate_x", {0.1}}}) == make_sine());
  CHECK(read({{"sensor_gain", "imu_rate_y", {0.0}}, {"sensor_delay", "imu_rate_y", {0.0}}}) ==
        make_sine());
}

TEST_CASE("Gain and bias scale and shift", "[unit][effects]") {
  const std::vector<double> y =
      read({{"sensor_gain", "imu_rate_y", {0.05}}, {"sensor_bias", "imu_rate_y", {0.2}}});
  for (std::size_t i = 0; i < y.size(); ++i) {
    CHECK(y[i] == Approx(1.05 * make_sine()[i] + 0.2).epsilon(1e-15));
  }
}

TEST_CASE("A late sensor reads what was", "[unit][reference][effects]") {
  const double late = GENERATE(3.7e-3, -2.2e-3);
  const std::vector<double> y = read({{"sensor_delay", "imu_rate_y", {late}}});
  for (std::size_t i = 10; i < 1990; ++i) {
    const double t = kStep * static_cast<double>(i) - late;
    // A spline's error, (w h)^4 / 384.
    CHECK(std::fabs(y[i] - std::sin(kW * t)) < tolerance(1e-8));
  }
  CHECK(y.front() == (late > 0.0 ? 0.0 : y.front()));  // nothing before the first sample
}

TEST_CASE("A late recorder delays every channel, beside its sensor", "[unit][effects]") {
  const EffectSettings late = {{"clock_offset", "", {2e-3}}};
  CHECK(read(late) == read({{"sensor_delay", "imu_rate_y", {2e-3}}}));
  const EffectSettings both = {{"clock_offset", "", {2e-3}},
                               {"sensor_delay", "imu_rate_y", {1e-3}}};
  CHECK(find_sensor(both, kRate).delay == Approx(3e-3));
  CHECK(find_sensor(both, kForce).delay == 2e-3);
  // Time and inputs are of the other recorder.
  for (const ModelInfo* model : list_models()) {
    for (const ChannelInfo& channel : model->channels) {
      if (model->has(kHasCar)) continue;
      INFO(model->name << " " << channel.name);
      const bool is_given =
          channel.name == "time" || find_input_derivative(*model, channel.name).input >= 0;
      CHECK(find_sensor(late, channel).delay == (is_given ? 0.0 : 2e-3));
    }
  }
}

TEST_CASE("A slow sensor is a first-order filter", "[unit][reference][effects]") {
  const double slow = 8e-3, ratio = kW * slow;
  const std::vector<double> y = read({{"sensor_lowpass", "imu_rate_y", {slow}}});
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double t = kStep * static_cast<double>(i);
    // The start's transient from 0, then the steady response.
    const double exact =
        (std::sin(kW * t) - ratio * std::cos(kW * t) + ratio * std::exp(-t / slow)) /
        (1.0 + ratio * ratio);
    CHECK(std::fabs(y[i] - exact) < tolerance(1e-8));  // a spline's error, (w h)^4 / 384
  }
}

TEST_CASE("A sensor far slower than its samples still settles", "[unit][effects]") {
  const double slow = GENERATE(1e-9, 1e-4, 0.4);
  const std::vector<double> y =
      read_sensor({{"sensor_lowpass", "force", {slow}}}, kForce, 1.0, std::vector<double>(9, 3.5));
  for (const double reading : y) CHECK(reading == Approx(3.5).epsilon(1e-14));
}

TEST_CASE("What is not finite has no reading, one sample stands for all", "[unit][effects]") {
  const EffectSettings late = {{"sensor_delay", "force", {1e-3}}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double y : read_sensor(late, kForce, kStep, {1.0, nan, 2.0})) CHECK(std::isnan(y));
  CHECK(read_sensor(late, kForce, kStep, {4.0}) == std::vector<double>{4.0});
  CHECK(read_sensor(late, kForce, kStep, {}).empty());
}

}  // namespace
}  // namespace strut
