#include "diagnose/decide/improvement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math/spread.h"

namespace strut {
namespace {

/// Sums over the runs, for one channel.
struct ChannelSums {
  int channel = 0;  // index in ModelInfo::channels
  double before = 0.0, after = 0.0, floor = 0.0, spread = 0.0, count = 0.0;
};

/// Excess error over the floors, each channel in units of its own.
struct Excess {
  double before = 0.0, after = 0.0;
};

double sum_squares(const std::vector<double>& residual) {
  double sum = 0.0;
  for (const double r : residual) {
    if (std::isfinite(r)) sum += r * r;
  }
  return sum;
}

ChannelSums& find_sums(std::vector<ChannelSums>& sums, int channel) {
  const auto found = std::find_if(sums.begin(), sums.end(),
                                  [&](const ChannelSums& s) { return s.channel == channel; });
  return found != sums.end() ? *found : sums.emplace_back(ChannelSums{channel});
}

std::vector<ChannelSums> sum_channels(const CampaignData& data, const Selection& selection,
                                      const std::vector<DiagnosedRun>& runs) {
  std::vector<ChannelSums> sums;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const DiagnosedRun& run = runs[i];
    if (!run.before.failure.empty() || !run.after.failure.empty()) continue;
    for (std::size_t k = 0; k < data.channels(run.run).size(); ++k) {
      const MeasuredChannel& c = data.channels(run.run)[k];
      ChannelSums& s = find_sums(sums, c.channel);
      const auto count = static_cast<double>(count_readings(run.before.residual[k]));
      s.before += sum_squares(run.before.residual[k]);
      s.after += sum_squares(run.after.residual[k]);
      s.floor += count * calc_noise_variance(selection.judge->get_noise(i), k);
      const double spread = calc_spread(c.values);
      s.spread += count * spread * spread;
      s.count += count;
    }
  }
  return sums;
}

ChannelImprovement make_channel(const CampaignData& data, const ChannelSums& s) {
  ChannelImprovement c;
  c.channel = data.info(s.channel).name;
  c.unit = data.info(s.channel).unit;
  c.rms_before = std::sqrt(s.before / s.count);
  c.rms_after = std::sqrt(s.after / s.count);
  c.noise_floor = std::sqrt(s.floor / s.count);
  const double spread = std::sqrt(s.spread / s.count);
  if (spread > 0.0) {
    c.nrmse_before = c.rms_before / spread;
    c.nrmse_after = c.rms_after / spread;
  }
  return c;
}

/// Relative tolerance of a channel's rms over its floor for a perfect model: the level of the noise
/// is uncertain by `noise.uncertainty`, the number of readings is finite, and roads differ.
double calc_floor_tolerance(const ChannelSums& s, const NoiseEstimate& noise) {
  constexpr double kRoad = 0.1;
  const double sensor_variance = noise.sigma * noise.sigma;
  const double road = 1.0 - std::min(1.0, sensor_variance * s.count / s.floor);
  return 2.0 * std::hypot(noise.uncertainty, 1.0 / std::sqrt(2.0 * s.count)) + kRoad * road;
}

void add_excess(const ChannelImprovement& c, double tolerance, Excess& excess) {
  const auto calc_excess = [&](double rms) {
    return std::max(0.0, rms / c.noise_floor - 1.0 - tolerance);
  };
  excess.before += calc_excess(c.rms_before);
  excess.after += calc_excess(c.rms_after);
}

std::optional<double> calc_explained(const Excess& excess) {
  if (!(excess.before > 0.0)) return std::nullopt;
  return std::max(-1.0, (excess.before - excess.after) / excess.before);
}

void fill_likelihood(const Selection& selection, Improvement& improvement) {
  double before = 0.0, after = 0.0, count = 0.0;
  for (std::size_t i = 0; i < selection.hold_out_before.size(); ++i) {
    const HoldOutRun &b = selection.hold_out_before[i], &a = selection.hold_out_after[i];
    if (!b.failure.empty() || !a.failure.empty()) continue;
    before += b.log_likelihood;
    after += a.log_likelihood;
    count += static_cast<double>(b.count);
  }
  if (!(count > 0.0)) return;
  improvement.log_likelihood_before = before / count;
  improvement.log_likelihood_after = after / count;
  improvement.log_odds = after - before;
}

}  // namespace

std::vector<DiagnosedRun> evaluate_hold_out(const CampaignData& data, const Selection& selection,
                                            int threads) {
  std::vector<DiagnosedRun> runs;
  for (const std::size_t r : data.list_runs(RunUse::kHoldOut)) {
    runs.push_back({r, evaluate_run(data, r, selection.base.shared(), threads),
                    evaluate_run(data, r, selection.extended.shared(), threads)});
  }
  return runs;
}

Improvement calc_improvement(const CampaignData& data, const Selection& selection,
                             const std::vector<DiagnosedRun>& runs) {
  Improvement improvement;
  Excess excess;
  for (const ChannelSums& s : sum_channels(data, selection, runs)) {
    if (!(s.count > 0.0)) continue;
    improvement.channels.push_back(make_channel(data, s));
    const double tolerance = calc_floor_tolerance(s, data.find_noise(s.channel));
    add_excess(improvement.channels.back(), tolerance, excess);
  }
  improvement.explained = calc_explained(excess);
  fill_likelihood(selection, improvement);
  return improvement;
}

}  // namespace strut
