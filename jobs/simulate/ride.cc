#include "jobs/simulate/ride.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "model/channel/car_channels.h"

namespace strut {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// (b0 + b1 s + b2 s^2) / (a0 + a1 s + a2 s^2), s in units of the section's own frequency.
struct Section {
  double frequency;  // Hz
  std::array<double, 3> b, a;
};

/// The factors of W_k: high-pass at 0.4 Hz, low-pass at 100 Hz (Butterworth), transition from
/// acceleration to velocity at 12.5 Hz (Q = 0.63), step up from 2.37 to 3.35 Hz (Q = 0.91); Table
/// A.1 of the standard. The step's numerator is written in units of 3.35 Hz.
std::array<Section, 4> list_sections() {
  constexpr double kRatio = 3.35 / 2.37;
  const double root = std::numbers::sqrt2;
  return {{{0.4, {0.0, 0.0, 1.0}, {1.0, root, 1.0}},
           {100.0, {1.0, 0.0, 0.0}, {1.0, root, 1.0}},
           {12.5, {1.0, 1.0, 0.0}, {1.0, 1.0 / 0.63, 1.0}},
           {3.35, {1.0 / (kRatio * kRatio), 1.0 / (0.91 * kRatio), 1.0}, {1.0, 1.0 / 0.91, 1.0}}}};
}

/// Filters in place by the bilinear transform, exact at the section's own frequency.
void filter(const Section& section, double rate, std::vector<double>& values) {
  const double k = 1.0 / std::tan(0.5 * kTwoPi * section.frequency / rate);
  const auto transform = [&](const std::array<double, 3>& c) {
    return std::array{c[0] + c[1] * k + c[2] * k * k, 2.0 * (c[0] - c[2] * k * k),
                      c[0] - c[1] * k + c[2] * k * k};
  };
  const auto b = transform(section.b), a = transform(section.a);
  double s1 = 0.0, s2 = 0.0;  // state, transposed direct form II
  for (double& value : values) {
    const double in = value;
    value = (b[0] * in + s1) / a[0];
    s1 = b[1] * in - a[1] * value + s2;
    s2 = b[2] * in - a[2] * value;
  }
}

double calc_rms(const std::vector<double>& values, double mean = 0.0) {
  double sum = 0.0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Largest root mean square over a second; before it is over, the run counts as preceded by rest.
double calc_transient(const std::vector<double>& weighted, double rate) {
  const auto second = static_cast<std::size_t>(std::round(rate));
  double sum = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < weighted.size(); ++i) {
    sum += weighted[i] * weighted[i];
    if (i >= second) sum -= weighted[i - second] * weighted[i - second];
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest / rate);
}

double calc_peak(const std::vector<double>& values) {
  double peak = 0.0;
  for (const double v : values) peak = std::max(peak, std::fabs(v));
  return peak;
}

double calc_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

AxleRide calc_axle_ride(const ReadChannel& read, int axle, double rate) {
  AxleRide ride;
  std::vector<bool> is_airborne;
  for (const int corner : {2 * axle, 2 * axle + 1}) {
    const std::vector<double> load =
        read(CarChannel::get_corner_channel(corner, CarChannel::kTireForceZ));
    is_airborne.resize(load.size(), false);
    for (std::size_t i = 0; i < load.size(); ++i) {
      if (load[i] <= 0.0) is_airborne[i] = true;
    }
    const double mean = calc_mean(load);
    ride.load_variation = std::max(ride.load_variation, calc_rms(load, mean) / mean);
    const int deflection =
        CarChannel::get_corner_channel(corner, CarChannel::kSuspensionDeflection);
    ride.travel = std::max(ride.travel, calc_peak(read(deflection)));
  }
  ride.airborne =
      static_cast<double>(std::count(is_airborne.begin(), is_airborne.end(), true)) / rate;
  return ride;
}

}  // namespace

std::vector<double> weight_acceleration(const std::vector<double>& acceleration, double rate) {
  std::vector<double> weighted = acceleration;
  for (const Section& section : list_sections()) filter(section, rate, weighted);
  return weighted;
}

std::vector<int> list_ride_channels() {
  std::vector<int> channels = {CarChannel::kBodyAccelerationZ};
  for (int corner = 0; corner < kCorners; ++corner) {
    for (const int channel : {CarChannel::kTireForceZ, CarChannel::kSuspensionDeflection}) {
      channels.push_back(CarChannel::get_corner_channel(corner, channel));
    }
  }
  return channels;
}

Ride calc_ride(const ReadChannel& read, double rate) {
  const std::vector<double> acceleration = read(CarChannel::kBodyAccelerationZ);
  Ride ride;
  ride.peak = calc_peak(acceleration);
  ride.rms = calc_rms(acceleration);
  if (rate >= kMinWeightedRate) {
    const std::vector<double> weighted = weight_acceleration(acceleration, rate);
    ride.weighted = calc_rms(weighted);
    ride.transient = calc_transient(weighted, rate);
  }
  for (std::size_t axle = 0; axle < kAxles; ++axle) {
    ride.axles[axle] = calc_axle_ride(read, static_cast<int>(axle), rate);
  }
  return ride;
}

}  // namespace strut
