#include "diagnose/campaign/noise_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace strut {
namespace {

constexpr std::size_t kBlock = 64, kOrder = 4;
constexpr double kWeights[kOrder + 1] = {1.0, -4.0, 6.0, -4.0, 1.0};
constexpr double kGain = 70.0;  // sum of their squares
/// Degrees of freedom of a block of 64 differences, whose neighbors are correlated by 0.8, 0.4,
/// 0.114, 0.014.
constexpr double kFreedom = static_cast<double>(kBlock) / 2.63;
/// Ratio of median to mean of a chi-square of so many degrees (E. B. Wilson, M. M. Hilferty, 1931).
constexpr double kCube = 1.0 - 2.0 / (9.0 * kFreedom), kMedianRatio = kCube * kCube * kCube;

/// The bands of calc_floor, in frequencies of a block.
constexpr std::size_t kFirst = 8, kBand = 4, kBands = 6;
/// Ratio of the quietest band's power to that of the differences below which these are motion.
constexpr double kNotWhite = 0.1;
/// Ratio of median to mean of a band's power: that of a chi-square of 3.6 degrees, since neighbors
/// under the window are correlated by 0.67, 0.19 and 0.02.
constexpr double kBandFreedom = 3.6, kBandCube = 1.0 - 2.0 / (9.0 * kBandFreedom);
constexpr double kBandMedian = kBandCube * kBandCube * kBandCube;

/// Squares of the differences without a missing sample.
std::vector<double> calc_squares(std::span<const double> values) {
  std::vector<double> squares;
  squares.reserve(values.size());
  for (std::size_t i = 0; i + kOrder < values.size(); ++i) {
    double d = 0.0;
    for (std::size_t k = 0; k <= kOrder; ++k) d += kWeights[k] * values[i + k];
    if (std::isfinite(d)) squares.push_back(d * d);
  }
  return squares;
}

double calc_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> calc_block_means(const std::vector<double>& squares) {
  std::vector<double> means;
  means.reserve(squares.size() / kBlock + 1);
  const std::size_t block = std::min(kBlock, squares.size());
  for (std::size_t i = 0; block > 0 && i + block <= squares.size(); i += block) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + block; ++k) sum += squares[k];
    means.push_back(sum / static_cast<double>(block));
  }
  return means;
}

/// The smallest difference between two different readings; 0 where all are equal.
double find_quantum(std::span<const double> values) {
  std::vector<double> levels;
  levels.reserve(values.size());
  for (const double v : values) {
    if (std::isfinite(v)) levels.push_back(v);
  }
  std::sort(levels.begin(), levels.end());
  if (levels.empty()) return 0.0;
  // Readings equal up to rounding are one level.
  const double same = 1e-9 * (levels.back() - levels.front());
  double quantum = 0.0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double step = levels[i] - levels[i - 1];
    if (step > same && (quantum == 0.0 || step < quantum)) quantum = step;
  }
  return quantum;
}

/// Power of white noise in each of the kBands bands of a block.
std::array<double, kBands> calc_band_powers(std::span<const double> block,
                                            const std::vector<double>& window, double weight,
                                            Eigen::FFT<double>& fft) {
  std::vector<double> faded(block.begin(), block.end());
  const double mean = std::accumulate(faded.begin(), faded.end(), 0.0) / kBlock;
  for (std::size_t i = 0; i < kBlock; ++i) faded[i] = window[i] * (faded[i] - mean);
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, faded);
  std::array<double, kBands> powers{};
  for (std::size_t k = 0; k < kBands * kBand; ++k) {
    powers[k / kBand] += std::norm(spectrum[kFirst + k]) / (weight * kBand);
  }
  return powers;
}

/// Power per sample of the white noise that the quietest band allows; infinity where no block is
/// without a missing sample.
double calc_floor(std::span<const double> values) {
  std::vector<double> window(kBlock);
  double weight = 0.0;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const double turn = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kBlock;
    window[i] = 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2.0 * turn) -
                0.01168 * std::cos(3.0 * turn);
    weight += window[i] * window[i];
  }
  Eigen::FFT<double> fft;  // makes its tables for the first block only
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  std::array<std::vector<double>, kBands> powers;
  for (std::size_t begin = 0; begin + kBlock <= values.size(); begin += kBlock) {
    const auto block = values.subspan(begin, kBlock);
    if (!std::all_of(block.begin(), block.end(), [](double v) { return std::isfinite(v); }))
      continue;
    const auto of_block = calc_band_powers(block, window, weight, fft);
    for (std::size_t b = 0; b < kBands; ++b) powers[b].push_back(of_block[b]);
  }
  double floor = std::numeric_limits<double>::infinity();
  for (std::vector<double>& band : powers) {
    if (!band.empty()) floor = std::min(floor, calc_median(std::move(band)) / kBandMedian);
  }
  return floor;
}

}  // namespace

NoiseEstimate estimate_noise(std::span<const double> values) {
  NoiseEstimate estimate;
  const std::vector<double> means = calc_block_means(calc_squares(values));
  estimate.quantum = find_quantum(values);
  const double rounding = estimate.quantum / std::sqrt(12.0);
  if (!means.empty()) estimate.sigma = std::sqrt(calc_median(means) / (kMedianRatio * kGain));
  // The standard error of the median of m blocks is 1.25 / sqrt(m) of that of one block.
  const double blocks = std::max(1.0, static_cast<double>(means.size()));
  estimate.uncertainty = 0.5 * 1.25 * std::sqrt(2.0 / (kFreedom * blocks));
  const double floor = calc_floor(values);
  if (floor < kNotWhite * estimate.sigma * estimate.sigma) {
    estimate.sigma = std::sqrt(floor);
    estimate.uncertainty *= std::sqrt(kFreedom / kBandFreedom);
  }
  if (estimate.sigma < rounding) {
    estimate.sigma = rounding;
    estimate.source = NoiseSource::kQuantized;
  }
  return estimate;
}

}  // namespace strut
