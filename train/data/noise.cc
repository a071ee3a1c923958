#include "train/data/noise.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/math/normal.h"
#include "base/math/random.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/store/shard_layout.h"
#include "train/data/training_file.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Streams of a draw's key: the hit time, then two per channel.
constexpr std::uint64_t kHitTimeStream = 0;
std::uint64_t get_bias_stream(std::size_t channel) { return 1 + 2 * channel; }
std::uint64_t get_noise_stream(std::size_t channel) { return 2 + 2 * channel; }

/// "NAME=VALUE,..."
std::string list_values(const std::vector<double>& values,
                        const std::vector<ColumnInfo>& channels) {
  std::string text;
  for (std::size_t c = 0; c < values.size(); ++c) {
    text += fmt::format("{}{}={}", c > 0 ? "," : "", channels[c].name, format_number(values[c]));
  }
  return text;
}

}  // namespace

void NoiseModel::validate(const std::vector<ColumnInfo>& channels) const {
  if (sigma.size() != channels.size() || bias.size() != channels.size()) {
    throw InputError(
        fmt::format("noise: must be given for each of the {} channels", channels.size()));
  }
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Range white = above(0.0, channels[c].unit), constant = at_least(0.0, channels[c].unit);
    if (!white.contains(sigma[c])) {
      throw InputError(fmt::format("noise of {} = {}: {}", channels[c].name,
                                   format_number(sigma[c]), white.describe()));
    }
    if (!constant.contains(bias[c])) {
      throw InputError(fmt::format("bias of {} = {}: {}", channels[c].name, format_number(bias[c]),
                                   constant.describe()));
    }
  }
  const Range shift = at_least(0.0, "s");
  if (!shift.contains(hit_time)) {
    throw InputError(fmt::format("standard deviation of the hit time = {}: {}",
                                 format_number(hit_time), shift.describe()));
  }
  if (copies < 1) throw InputError(fmt::format("copies = {}: must be at least 1", copies));
}

NoiseDraw::NoiseDraw(const NoiseModel& model, std::int64_t row, int copy)
    : model_(&model),
      key_(calc_random_bits(model.seed, static_cast<std::uint64_t>(copy),
                            static_cast<std::uint64_t>(row))) {}

double NoiseDraw::calc_hit_time() const {
  const double max = NoiseModel::kMaxDeviations;
  return model_->hit_time * std::clamp(calc_normal(key_, kHitTimeStream, 0), -max, max);
}

void NoiseDraw::add(std::size_t channel, std::span<double> samples) const {
  const double sigma = model_->sigma[channel];
  const double bias = model_->bias[channel] * calc_normal(key_, get_bias_stream(channel), 0);
  const std::uint64_t stream = get_noise_stream(channel);
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    const auto [first, second] = calc_normal_pair(key_, stream, i / 2);
    samples[i] += bias + sigma * first;
    if (i + 1 < samples.size()) samples[i + 1] += bias + sigma * second;
  }
}

NamedTexts describe_noise(const NoiseModel& noise, const std::vector<ColumnInfo>& channels) {
  return {{"noise", list_values(noise.sigma, channels)},
          {"bias", list_values(noise.bias, channels)},
          {"hit_time", format_number(noise.hit_time)},
          {"copies", std::to_string(noise.copies)},
          {"noise_seed", std::to_string(noise.seed)}};
}

void write_noise(Hdf5Writer& file, const std::string& name, const NoiseModel& noise,
                 const std::vector<ColumnInfo>& channels) {
  std::vector<double> rows = noise.sigma;
  rows.insert(rows.end(), noise.bias.begin(), noise.bias.end());
  const ShardColumn table = make_table_column(
      name.c_str(), channels, "1 sigma of each sample's noise, and of a record's constant bias");
  file.write(name, rows, channels.size(), table.label);
  file.write_attribute(name, "hit_time_sigma", noise.hit_time);
  file.write_attribute(name, "copies", std::int64_t{noise.copies});
  file.write_attribute(name, "seed", static_cast<std::int64_t>(noise.seed));
}

NoiseModel read_noise(const fs::path& path, const Hdf5Reader& file, const std::string& name,
                      std::vector<ColumnInfo>& channels) {
  TwoRowTable table = read_two_rows(path, file, name);
  channels = std::move(table.columns);
  NoiseModel noise{std::move(table.first), std::move(table.second)};
  noise.hit_time = file.read_number_attribute(name, "hit_time_sigma");
  noise.copies =
      to_int(path, name, static_cast<double>(file.read_integer_attribute(name, "copies")));
  noise.seed = static_cast<std::uint64_t>(file.read_integer_attribute(name, "seed"));
  try {
    noise.validate(channels);
  } catch (const InputError& e) {
    fail_file(path, name + ": " + e.what());
  }
  return noise;
}

void add_noise(Checksum& sum, const NoiseModel& noise) {
  sum.add(noise.sigma);
  sum.add(noise.bias);
  sum.add(std::vector<double>{noise.hit_time});
  sum.add(std::vector<std::int64_t>{noise.copies, static_cast<std::int64_t>(noise.seed)});
}

}  // namespace strut
