// Sensor noise and its counter-based draws.
#include "train/data/noise.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "estimate/sensor_noise.h"
#include "tests/support/test_car.h"
#include "train/data/dataset_source.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;

const std::vector<ColumnInfo> kChannels = {{"a", "m", ""}, {"b", "rad", ""}};

TEST_CASE("Normal numbers have the moments of the normal distribution", "[statistical]") {
  const int n = 200000;
  double sum = 0.0, squares = 0.0, fourth = 0.0, neighbors = 0.0, before = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = calc_normal(3, 5, static_cast<std::uint64_t>(i));
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
    neighbors += x * before;
    before = x;
  }
  // Five standard errors of the means: 1, sqrt(2), sqrt(96), 1 over sqrt(n).
  const double error = 5.0 / std::sqrt(n);
  CHECK(std::abs(sum / n) < error);
  CHECK(std::abs(squares / n - 1.0) < std::sqrt(2.0) * error);
  CHECK(std::abs(fourth / n - 3.0) < std::sqrt(96.0) * error);
  CHECK(std::abs(neighbors / n) < error);
}

TEST_CASE("A draw adds the bias of its record and the noise of its samples", "[statistical]") {
  const NoiseModel noise{{0.5, 2.0}, {3.0, 0.0}, 0.01, 1, 9};
  const int records = 4000, samples = 20;
  double variance = 0.0, mean_variance = 0.0, other = 0.0, hit = 0.0;
  for (int r = 0; r < records; ++r) {
    const NoiseDraw draw(noise, r, 0);
    std::vector<double> a(samples, 1.0), b(samples, 0.0);
    draw.add(0, a);
    draw.add(1, b);
    double mean = 0.0;
    for (const double x : a) mean += x / samples;
    for (const double x : a) variance += (x - mean) * (x - mean) / (samples - 1) / records;
    mean_variance += (mean - 1.0) * (mean - 1.0) / records;
    for (const double x : b) other += x * x / samples / records;
    hit += draw.calc_hit_time() * draw.calc_hit_time() / records;
  }
  // Five relative standard errors of a variance of n numbers, sqrt(2 / n).
  const double of_samples = 5.0 * std::sqrt(2.0 / (records * (samples - 1)));
  const double of_records = 5.0 * std::sqrt(2.0 / records);
  CHECK(variance == Approx(0.25).epsilon(of_samples));
  CHECK(mean_variance == Approx(9.0 + 0.25 / samples).epsilon(of_records));
  CHECK(other == Approx(4.0).epsilon(of_samples));
  CHECK(hit == Approx(1e-4).epsilon(of_records));
}

TEST_CASE("A draw depends only on seed, case, copy and channel", "[property]") {
  const auto draw = [](std::uint64_t seed, std::int64_t row, int copy, std::size_t channel) {
    const NoiseModel noise{{1.0, 1.0}, {0.0, 0.0}, 0.0, 4, seed};
    std::vector<double> samples(5, 0.0);
    NoiseDraw(noise, row, copy).add(channel, samples);
    return samples;
  };
  const auto first = draw(1, 2, 3, 1);
  CHECK(draw(1, 2, 3, 1) == first);
  std::set<double> others = {first[0]};
  for (const auto& samples :
       {draw(2, 2, 3, 1), draw(1, 3, 3, 1), draw(1, 2, 2, 1), draw(1, 3, 2, 1), draw(1, 2, 3, 0)}) {
    others.insert(samples[0]);
  }
  CHECK(others.size() == 6);
}

TEST_CASE("Invalid noise is refused with channel and value", "[unit]") {
  const auto check = [](const NoiseModel& noise, const char* text) {
    CHECK_THROWS_WITH(noise.validate(kChannels), Contains(text));
  };
  NoiseModel{{1.0, 2.0}, {0.0, 0.0}}.validate(kChannels);
  check({{1.0, 0.0}, {0.0, 0.0}}, "noise of b = 0: must be > 0 rad");
  check({{-1.0, 1.0}, {0.0, 0.0}}, "noise of a = -1");
  check({{1.0, std::nan("")}, {0.0, 0.0}}, "noise of b");
  check({{1.0, 1.0}, {0.0, -2.0}}, "bias of b = -2");
  check({{1.0}, {0.0}}, "each of the 2 channels");
  check({{1.0, 1.0}, {0.0, 0.0}, -1.0}, "hit time");
  check({{1.0, 1.0}, {0.0, 0.0}, 0.0, 0}, "copies = 0");
}

TEST_CASE("Channels with a default bias have noise, and a bias larger than it", "[unit]") {
  const SensorNoise noise = make_default_noise(), bias = make_default_bias();
  int biased = 0;
  for (std::size_t c = 0; c < bias.size(); ++c) {
    if (bias[c] == 0.0) continue;
    ++biased;
    INFO(list_car_channels()[c].name);
    CHECK(noise[c] > 0.0);
    CHECK(bias[c] > noise[c]);
  }
  CHECK(biased == 12 + 2 * kCorners);
  // Data sheets: offsets of 20 to 60 mg, 0.5 to 3 deg/s.
  CHECK(bias[CarChannel::kImuAccelerationZ] == Approx(9.81 * 0.04).margin(9.81 * 0.02));
  CHECK(bias[CarChannel::kImuRateY] == Approx(0.0305).margin(0.0218));
}

TEST_CASE("Noisy copies of a snapshot stay in the part of their case", "[property]") {
  UsableRows usable{{{"x", "m", ""}}, {{"number", "1", ""}}, RowStore(2)};
  for (int i = 0; i < 40; ++i) {
    usable.rows.append(std::vector<double>{0.1 * i, static_cast<double>(i)});
  }
  const NoiseModel noise{{0.5}, {0.0}, 0.0, 5, 3};
  const TrainingRows rows = split_rows(std::move(usable), {}, {}, noise);
  std::set<double> seen;
  std::size_t cases = 0;
  double squares = 0.0;
  for (const RowStore* part : {&rows.train, &rows.validate, &rows.test}) {
    std::multiset<double> own;
    std::vector<double> row(2);
    for (std::size_t i = 0; i < part->row_count(); ++i) {
      part->read(i, 1, row.data());
      own.insert(row[1]);
      seen.insert(row[1]);
      squares += (row[0] - 0.1 * row[1]) * (row[0] - 0.1 * row[1]);
    }
    for (const double number : own) CHECK(own.count(number) == 5);
    cases += own.size() / 5;
  }
  CHECK(cases == 40);
  CHECK(seen.size() == 40);
  CHECK(squares / 200 == Approx(0.25).epsilon(5.0 * std::sqrt(2.0 / 200)));
}

}  // namespace
}  // namespace strut
