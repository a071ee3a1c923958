// Synthetic records of two channels, a pulse and a decaying sine; their parameters are size and
// frequency.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/math/random.h"
#include "io/store/shard.h"
#include "tests/support/example_shard.h"
#include "tests/support/temporary_folder.h"
#include "train/window/records.h"

namespace strut::test {

inline constexpr double kPulseInterval = 0.01;  // s
inline constexpr std::size_t kPulseSamples = 201;

/// Channel `c` at time t [s] of the pulse that starts at `start` [s].
inline double calc_pulse(std::size_t c, double t, double start, double size, double frequency) {
  const double s = t - start;
  const double bump = std::exp(-0.5 * (s - 0.1) * (s - 0.1) / (0.04 * 0.04));
  if (c == 0) return 9.81 + size * bump;
  return s > 0.0 ? size * s * s * std::exp(-s / 0.15) * std::sin(frequency * s) : 0.0;
}

inline ShardSchema make_pulse_schema() {
  ShardSchema schema = make_example_schema();
  schema.parameters = {{"size", "m", "of the pulse"}, {"frequency", "rad/s", "of the sine"}};
  schema.history = {{"imu_acceleration_z", "m/s^2", ""}, {"imu_rate_y", "rad/s", ""}};
  schema.history_samples = kPulseSamples;
  schema.history_interval = kPulseInterval;
  return schema;
}

inline ShardRows make_pulse_rows(const ShardSchema& schema, std::size_t count) {
  ShardRows rows = make_example_rows(schema, count);
  rows.parameters.clear();
  for (std::size_t i = 0; i < count; ++i) {
    rows.status[i] = 0;
    const double size = 4.0 + calc_uniform(1, 1, i), frequency = 20.0 + calc_uniform(1, 2, i);
    rows.parameters.insert(rows.parameters.end(), {size, frequency});
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t k = 0; k < kPulseSamples; ++k) {
        const double t = static_cast<double>(k) * kPulseInterval;
        rows.history[c][i * kPulseSamples + k] = calc_pulse(c, t, 0.5, size, frequency);
      }
    }
  }
  return rows;
}

inline std::filesystem::path write_pulses(const TemporaryFolder& folder, std::size_t count) {
  const ShardSchema schema = make_pulse_schema();
  const auto image = make_shard_image(compress_shard(schema, make_pulse_rows(schema, count)),
                                      make_example_provenance(1));
  std::filesystem::path path = folder / "pulses.h5";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()),
             static_cast<std::streamsize>(image.size()));
  return path;
}

inline NoiseModel make_pulse_noise() { return {{0.02, 0.01}, {0.1, 0.05}, 0.01, 3, 7}; }

}  // namespace strut::test
