// Sensor noise of records, and its random draws for training.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/format/hdf5.h"
#include "io/format/named_texts.h"
#include "io/store/shard.h"

namespace strut {

class Checksum;

/// Errors of the measured channels. White noise is Gaussian and independent between samples; a bias
/// is one Gaussian number per record; the hit time (windows only) is a Gaussian shift of the record
/// along its time axis.
struct NoiseModel {
  /// Draws of the hit time are clamped to this many standard deviations.
  static constexpr double kMaxDeviations = 6.0;

  std::vector<double> sigma;  // standard deviation of white noise per channel, in its unit
  std::vector<double> bias;   // standard deviation of the bias per channel, in its unit
  double hit_time = 0.0;      // s, standard deviation
  int copies = 1;             // draws per case
  std::uint64_t seed = 1;

  /// Throws InputError, which names channel and value, unless each of `channels` has a sigma above
  /// 0 and a bias of at least 0, and there is at least one copy.
  void validate(const std::vector<ColumnInfo>& channels) const;
};

/// The errors of one copy of one case. The random numbers are counter-based (base/math/random.h):
/// they do not depend on earlier draws.
class NoiseDraw {
 public:
  NoiseDraw(const NoiseModel& model, std::int64_t row, int copy);

  /// Hit time [s]: the record at t shows what happened at t - hit time.
  double calc_hit_time() const;
  /// Adds bias and noise to the samples of a channel.
  void add(std::size_t channel, std::span<double> samples) const;

 private:
  const NoiseModel* model_;
  std::uint64_t key_;
};

/// Lists everything that determines the draws, for reports and for comparing trainings.
NamedTexts describe_noise(const NoiseModel& noise, const std::vector<ColumnInfo>& channels);

/// Writes a dataset with rows sigma and bias over the channels, and the rest as its attributes.
void write_noise(Hdf5Writer& file, const std::string& name, const NoiseModel& noise,
                 const std::vector<ColumnInfo>& channels);
/// Reads noise and its channels. Throws InputError, which names file and dataset.
NoiseModel read_noise(const std::filesystem::path& path, const Hdf5Reader& file,
                      const std::string& name, std::vector<ColumnInfo>& channels);
void add_noise(Checksum& sum, const NoiseModel& noise);

}  // namespace strut
