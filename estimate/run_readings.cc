#include "estimate/run_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

bool is_parameter_of(const Unknown& u, std::size_t run) {
  return is_of_simulation(u) && belongs(u, run);
}

std::size_t find_hit_time(const std::vector<Unknown>& unknowns, std::size_t run) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns[i].kind == UnknownKind::kHitTime && belongs(unknowns[i], run)) return i;
  }
  return kNoUnknown;
}

std::pair<double, double> calc_sides(const Unknown& u, double value, double relative_step) {
  const double h = relative_step * u.scale;
  const double center = std::max(u.low + h, std::min(u.high - h, value));
  return {center + h, center - h};
}

RunReadings::RunReadings(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
                         const MeasuredRun& run, std::size_t run_index, double step,
                         const std::vector<ReadingPlace>& places)
    : unknowns_(unknowns),
      values_(values),
      run_(run),
      index_(run_index),
      step_(step),
      places_(places) {
  const std::size_t hit = find_hit_time(unknowns, run_index);
  hit_time_ = hit == kNoUnknown ? 0.0 : values[hit];
  rows_.reserve(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k].run == run_index) rows_.push_back(k);
  }
}

std::size_t RunReadings::fill(const SampledRun* results, double relative_step,
                              Linearization& out) const {
  std::size_t used = 1;
  fill_residual(results[0], values_, out.residual);
  fill_base_columns(results[0], out);
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    if (!is_parameter_of(unknowns_[i], index_)) continue;
    const auto [upper, lower] = calc_sides(unknowns_[i], values_[i], relative_step);
    const bool centered = std::abs(0.5 * (upper + lower) - values_[i]) < 1e-3 * (upper - lower);
    fill_parameter(results, used, upper - lower, centered, i, out);
    used += 2;
  }
  return used;
}

double RunReadings::find_best_hit_time(const SampledRun& base) const {
  const Unknown& u = unknowns_[find_hit_time(unknowns_, index_)];
  // On a bound a search would be held there.
  const auto first = static_cast<int>(std::floor((u.low - hit_time_) / kAlignStep)) + 1;
  const auto last = static_cast<int>(std::ceil((u.high - hit_time_) / kAlignStep)) - 1;
  double best = hit_time_, least = kInfinity;
  for (int k = first; k <= last; ++k) {
    const double hit_time = hit_time_ + k * kAlignStep;
    const double off = u.prior.informs() ? (hit_time - u.prior.mean) / u.prior.sigma : 0.0;
    const double chi2 = calc_chi2(base, hit_time) + off * off;
    if (chi2 >= least) continue;
    least = chi2;
    best = hit_time;
  }
  return best;
}

RunReadings::Bias RunReadings::get_bias(const MeasuredChannel& channel) const {
  for (const Unknown& u : unknowns_) {
    if (u.kind != UnknownKind::kBias || u.channel != channel.channel || !belongs(u, index_)) {
      continue;
    }
    const double share = channel.sigma / u.prior.sigma;
    return {u.prior.mean / channel.sigma, share * share};
  }
  return {0.0, kInfinity};
}

CurvePoint RunReadings::read(const SampledRun& simulated, const ReadingPlace& place,
                             double hit_time) const {
  const double at = (run_.times[place.time] + hit_time) / step_;
  const double index = std::floor(at);
  const std::vector<double>& series = simulated[place.channel];
  return interpolate_curve([&](std::size_t sample) { return series[sample]; },
                           static_cast<std::size_t>(index), at - index, step_);
}

/// Sum over the channels of min over b of sum (e + b)^2 + information b^2, which is
/// sum e^2 - (sum e)^2 / (count + information).
double RunReadings::calc_chi2(const SampledRun& base, double hit_time) const {
  double chi2 = 0.0;
  for (std::size_t channel = 0; channel < run_.channels.size(); ++channel) {
    const MeasuredChannel& c = run_.channels[channel];
    const Bias bias = get_bias(c);
    double count = 0.0, sum = 0.0, squares = 0.0;
    for (const std::size_t k : rows_) {
      const ReadingPlace& place = places_[k];
      if (place.channel != channel) continue;
      const double simulated = read(base, place, hit_time).value;
      const double e = (simulated - c.values[place.time]) / c.sigma + bias.mean;
      ++count;
      sum += e;
      squares += e * e;
    }
    chi2 += squares - sum * sum / std::max(1.0, count + bias.information);
  }
  return chi2;
}

void RunReadings::fill_residual(const SampledRun& base, const std::vector<double>& values,
                                Eigen::VectorXd& residual) const {
  std::vector<double> bias(run_.channels.size(), 0.0);
  double hit_time = 0.0;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (!belongs(u, index_)) continue;
    if (u.kind == UnknownKind::kHitTime) hit_time = values[i];
    if (u.kind != UnknownKind::kBias) continue;
    for (std::size_t c = 0; c < bias.size(); ++c) {
      if (run_.channels[c].channel == u.channel) bias[c] += values[i];
    }
  }
  for (const std::size_t k : rows_) {
    const MeasuredChannel& c = run_.channels[places_[k].channel];
    const double simulated = read(base, places_[k], hit_time).value + bias[places_[k].channel];
    residual(static_cast<Eigen::Index>(k)) = (simulated - c.values[places_[k].time]) / c.sigma;
  }
}

void RunReadings::fill_base_columns(const SampledRun& base, Linearization& out) const {
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    const bool is_time = u.kind == UnknownKind::kHitTime;
    if (!belongs(u, index_) || (!is_time && u.kind != UnknownKind::kBias)) continue;
    const auto column = static_cast<Eigen::Index>(i);
    for (const std::size_t k : rows_) {
      const MeasuredChannel& c = run_.channels[places_[k].channel];
      if (!is_time && u.channel != c.channel) continue;
      const double slope = is_time ? read(base, places_[k], hit_time_).slope : 1.0;
      out.jacobian(static_cast<Eigen::Index>(k), column) = slope * u.scale / c.sigma;
    }
  }
}

/// Differences of two runs; a column in which the second difference is as large as the first
/// holds nothing but rounding, as its step is short, and becomes zero.
void RunReadings::fill_parameter(const SampledRun* results, std::size_t upper, double width,
                                 bool centered, std::size_t unknown, Linearization& out) const {
  constexpr double kRounding = 0.5;
  double slopes = 0.0, bends = 0.0;
  const auto column = static_cast<Eigen::Index>(unknown);
  for (const std::size_t k : rows_) {
    const double sigma = run_.channels[places_[k].channel].sigma;
    const double above = read(results[upper], places_[k], hit_time_).value;
    const double below = read(results[upper + 1], places_[k], hit_time_).value;
    const double here = read(results[0], places_[k], hit_time_).value;
    const double slope = (above - below) / sigma, bend = (above - 2.0 * here + below) / sigma;
    slopes += slope * slope;
    bends += bend * bend;
    out.jacobian(static_cast<Eigen::Index>(k), column) = slope / width * unknowns_[unknown].scale;
  }
  if (!centered || std::sqrt(bends) <= kRounding * std::sqrt(slopes)) return;
  for (const std::size_t k : rows_) out.jacobian(static_cast<Eigen::Index>(k), column) = 0.0;
}

}  // namespace strut
