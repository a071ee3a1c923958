#include "estimate/hit_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strut {
namespace {

/// Interval of the grid of hit times; a wheel is on the flank of a bump for about ten of them.
constexpr double kAlignStep = 1e-3;  // s

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A Gaussian prior of a channel's bias in sigmas of its noise; infinite information: not an
/// unknown.
struct BiasPrior {
  double mean = 0.0, information = kInfinity;
};

BiasPrior find_bias_prior(const std::vector<Unknown>& unknowns, std::size_t run,
                          const MeasuredChannel& channel) {
  for (const Unknown& u : unknowns) {
    if (u.kind != UnknownKind::kBias || u.channel != channel.channel || !belongs(u, run)) continue;
    const double ratio = channel.sigma / u.prior.sigma;
    return {u.prior.mean / channel.sigma, ratio * ratio};
  }
  return {};
}

/// Sums over the errors of a channel, each divided by its sigma.
struct ErrorSums {
  double count = 0.0, sum = 0.0, squares = 0.0;
};

/// Sum over the channels of min over b of sum (e + b)^2 + information b^2, which is
/// sum e^2 - (sum e)^2 / (count + information). `biases`: by channel.
double calc_chi2(const std::vector<BiasPrior>& biases, const MeasuredRun& run,
                 std::span<const ReadingPlace> readings, const SampledRun& base, double hit_time,
                 double step) {
  std::vector<ErrorSums> channels(biases.size());
  for (const ReadingPlace& place : readings) {
    const MeasuredChannel& c = run.channels[place.channel];
    const double simulated = read_curve(run, base, place, hit_time, step).value;
    const double e = (simulated - c.values[place.time]) / c.sigma + biases[place.channel].mean;
    ErrorSums& errors = channels[place.channel];
    ++errors.count;
    errors.sum += e;
    errors.squares += e * e;
  }
  double chi2 = 0.0;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto& [count, sum, squares] = channels[c];
    chi2 += squares - sum * sum / std::max(1.0, count + biases[c].information);
  }
  return chi2;
}

}  // namespace

std::size_t find_hit_time(const std::vector<Unknown>& unknowns, std::size_t run) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns[i].kind == UnknownKind::kHitTime && belongs(unknowns[i], run)) return i;
  }
  return kNoUnknown;
}

double get_hit_time(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
                    std::size_t run) {
  const std::size_t hit = find_hit_time(unknowns, run);
  return hit == kNoUnknown ? 0.0 : values[hit];
}

CurvePoint read_curve(const MeasuredRun& run, const SampledRun& sampled, const ReadingPlace& place,
                      double hit_time, double step) {
  const double at = (run.times[place.time] + hit_time) / step;
  const double index = std::floor(at);
  const std::vector<double>& series = sampled[place.channel];
  return interpolate_curve([&](std::size_t sample) { return series[sample]; },
                           static_cast<std::size_t>(index), at - index, step);
}

double find_best_hit_time(const std::vector<Unknown>& unknowns, const MeasuredRun& run,
                          std::span<const ReadingPlace> readings, const SampledRun& base,
                          double start, double step) {
  const Unknown& u = unknowns[find_hit_time(unknowns, readings.front().run)];
  // Excludes the bounds, where a search would be held.
  const auto first = static_cast<int>(std::floor((u.low - start) / kAlignStep)) + 1;
  const auto last = static_cast<int>(std::ceil((u.high - start) / kAlignStep)) - 1;
  std::vector<BiasPrior> biases;
  for (const MeasuredChannel& c : run.channels) {
    biases.push_back(find_bias_prior(unknowns, readings.front().run, c));
  }
  double best = start, min_chi2 = kInfinity;
  for (int k = first; k <= last; ++k) {
    const double hit_time = start + k * kAlignStep;
    const double off = u.prior.informs() ? (hit_time - u.prior.mean) / u.prior.sigma : 0.0;
    const double chi2 = calc_chi2(biases, run, readings, base, hit_time, step) + off * off;
    if (chi2 >= min_chi2) continue;
    min_chi2 = chi2;
    best = hit_time;
  }
  return best;
}

}  // namespace strut
