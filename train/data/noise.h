// What sensors add to a record, and the draws of it that a network trains on.
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
/// is one Gaussian number for a whole record; the hit time, in windows alone, is a Gaussian shift
/// of the record against its time axis.
struct NoiseModel {
  /// A hit time is drawn within so many standard deviations.
  static constexpr double kMostDeviations = 6.0;

  std::vector<double> sigma;  // per channel, in its unit: 1 sigma of a sample's noise
  std::vector<double> bias;   // per channel, in its unit: 1 sigma of a record's bias
  double hit_time = 0.0;      // s, 1 sigma
  int copies = 1;             // draws of each case
  std::uint64_t seed = 1;     // of all draws

  /// Throws InputError that names the channel and its value, unless there is one sigma above 0 and
  /// one bias of at least 0 for each of `channels`, and at least one copy.
  void validate(const std::vector<ColumnInfo>& channels) const;
};

/// The errors of one copy of one case. Every number is that of its place (base/math/random.h): it
/// depends on nothing that was drawn before.
class NoiseDraw {
 public:
  NoiseDraw(const NoiseModel& model, std::int64_t row, int copy);

  /// s; what is recorded at t is what happened at t - hit time.
  double calc_hit_time() const;
  /// Adds bias and noise to the samples of a channel.
  void add(std::size_t channel, std::span<double> samples) const;

 private:
  const NoiseModel* model_;
  std::uint64_t key_;
};

/// What decides the draws, for people and for comparing trainings.
NamedTexts describe_noise(const NoiseModel& noise, const std::vector<ColumnInfo>& channels);

/// A dataset of sigma and bias over the channels, with the rest as its attributes.
void write_noise(Hdf5Writer& file, const std::string& name, const NoiseModel& noise,
                 const std::vector<ColumnInfo>& channels);
/// Also reads the channels. Throws InputError that names file and dataset.
NoiseModel read_noise(const std::filesystem::path& path, const Hdf5Reader& file,
                      const std::string& name, std::vector<ColumnInfo>& channels);
void add_noise(Checksum& sum, const NoiseModel& noise);

}  // namespace strut
