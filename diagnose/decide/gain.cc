#include "diagnose/decide/gain.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math/spread.h"

namespace strut {
namespace {

/// Sums over runs, of one channel.
struct ChannelSums {
  double before = 0.0, after = 0.0, floor = 0.0, spread = 0.0, count = 0.0;
};

/// How far over its floor a channel of a perfect model may be, relative: the noise's level is known
/// to `uncertainty`, a record has but `count` readings of it, and every road is its own.
double calc_floor_tolerance(const ChannelSums& s, double uncertainty, double sensor_variance) {
  constexpr double kRoad = 0.1;
  const double road = 1.0 - std::min(1.0, sensor_variance * s.count / s.floor);
  return 2.0 * std::hypot(uncertainty, 1.0 / std::sqrt(2.0 * s.count)) + kRoad * road;
}

/// What is gone of what was above the floors, each channel in units of its own.
class ExplainedShare {
 public:
  void add(const ChannelGain& c, double tolerance) {
    const auto above = [&](double rms) {
      return std::max(0.0, rms / c.noise_floor - 1.0 - tolerance);
    };
    before_ += above(c.rms_before);
    after_ += above(c.rms_after);
  }
  /// Nothing where nothing was above.
  std::optional<double> get() const {
    if (!(before_ > 0.0)) return std::nullopt;
    return std::max(-1.0, (before_ - after_) / before_);
  }

 private:
  double before_ = 0.0, after_ = 0.0;
};

double sum_squares(const std::vector<double>& residual) {
  double sum = 0.0;
  for (const double r : residual) {
    if (std::isfinite(r)) sum += r * r;
  }
  return sum;
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

HoldOutGain calc_hold_out_gain(const CampaignData& data, const Selection& selection,
                               const std::vector<DiagnosedRun>& runs) {
  HoldOutGain gain;
  std::vector<int> channels;
  std::vector<ChannelSums> sums;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const DiagnosedRun& run = runs[i];
    if (!run.before.failure.empty() || !run.after.failure.empty()) continue;
    for (std::size_t k = 0; k < data.channels(run.run).size(); ++k) {
      const MeasuredChannel& c = data.channels(run.run)[k];
      auto at = std::find(channels.begin(), channels.end(), c.channel) - channels.begin();
      if (at == static_cast<std::ptrdiff_t>(channels.size())) {
        channels.push_back(c.channel);
        sums.emplace_back();
      }
      ChannelSums& s = sums[static_cast<std::size_t>(at)];
      const auto count = static_cast<double>(count_readings(run.before.residual[k]));
      s.before += sum_squares(run.before.residual[k]);
      s.after += sum_squares(run.after.residual[k]);
      s.floor += count * calc_noise_variance(selection.judge->get_noise(i), k);
      const double spread = calc_spread(c.values);
      s.spread += count * spread * spread;
      s.count += count;
    }
  }
  ExplainedShare explained;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const ChannelSums& s = sums[i];
    if (!(s.count > 0.0)) continue;
    ChannelGain c;
    c.channel = data.info(channels[i]).name;
    c.unit = data.info(channels[i]).unit;
    c.rms_before = std::sqrt(s.before / s.count);
    c.rms_after = std::sqrt(s.after / s.count);
    c.noise_floor = std::sqrt(s.floor / s.count);
    const double spread = std::sqrt(s.spread / s.count);
    if (spread > 0.0) {
      c.nrmse_before = c.rms_before / spread;
      c.nrmse_after = c.rms_after / spread;
    }
    const NoiseEstimate& noise = data.find_noise(channels[i]);
    explained.add(c, calc_floor_tolerance(s, noise.uncertainty, noise.sigma * noise.sigma));
    gain.channels.push_back(std::move(c));
  }
  gain.explained = explained.get();
  double before = 0.0, after = 0.0, count = 0.0;
  for (std::size_t i = 0; i < selection.hold_out_before.size(); ++i) {
    const HoldOutRun &b = selection.hold_out_before[i], &a = selection.hold_out_after[i];
    if (!b.failure.empty() || !a.failure.empty()) continue;
    before += b.log_likelihood;
    after += a.log_likelihood;
    count += static_cast<double>(b.count);
  }
  if (count > 0.0) {
    gain.log_likelihood_before = before / count;
    gain.log_likelihood_after = after / count;
    gain.log_odds = after - before;
  }
  return gain;
}

}  // namespace strut
