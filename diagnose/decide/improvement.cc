#include "diagnose/decide/improvement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel/team.h"
#include "diagnose/baseline/time_windows.h"
#include "diagnose/campaign/campaign_unknowns.h"
#include "diagnose/decide/acceptance.h"

namespace strut {
namespace {

/// Sums over the runs, for one channel.
struct ChannelSums {
  int channel = 0;  // index in ModelInfo::channels
  double before = 0.0, after = 0.0, floor = 0.0, common = 0.0, tolerance = 0.0, spread = 0.0,
         count = 0.0;
};

/// Excess error over the floors, each channel in units of its own.
struct Excess {
  double before = 0.0, after = 0.0;
};

ChannelSums& find_sums(std::vector<ChannelSums>& sums, int channel) {
  const auto found = std::find_if(sums.begin(), sums.end(),
                                  [&](const ChannelSums& s) { return s.channel == channel; });
  return found != sums.end() ? *found : sums.emplace_back(ChannelSums{channel});
}

bool is_held_out(const CampaignData& data, const DiagnosedRun& run) {
  return data.campaign.runs[run.run].use == RunUse::kHoldOut;
}

std::vector<ChannelSums> sum_channels(const CampaignData& data,
                                      const std::vector<DiagnosedRun>& runs) {
  std::vector<ChannelSums> sums;
  for (const DiagnosedRun& run : runs) {
    if (!is_held_out(data, run) || run.before.channels.empty() || run.after.channels.empty()) {
      continue;
    }
    for (std::size_t k = 0; k < run.before.channels.size(); ++k) {
      const ChannelComparison &before = run.before.channels[k], &after = run.after.channels[k];
      ChannelSums& s = find_sums(sums, before.channel);
      const auto count = static_cast<double>(before.count);
      const NoiseFloor& floor = before.adequacy.floor;
      s.before += count * before.rms * before.rms;
      s.after += count * after.rms * after.rms;
      s.floor += count * floor.sigma * floor.sigma;
      s.common += count * floor.sigma * floor.sigma * floor.common_fraction;
      s.tolerance +=
          count * floor.sigma * floor.sigma * floor.common_fraction * floor.common_tolerance;
      s.spread += count * before.measured_spread * before.measured_spread;
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
  improvement.hold_out = calc_fall(selection.hold_out_before, selection.hold_out_after,
                                   calc_misfit(selection.extended.fit, 0.0));
}

}  // namespace

std::vector<DiagnosedRun> evaluate_runs(const CampaignData& data, const Diagnosis& diagnosis,
                                        int threads) {
  const WhitenedFit& base = diagnosis.selection.base;
  const SharedValues before = base.shared(), after = diagnosis.selection.extended.shared();
  SharedValues nominal = before;
  for (std::size_t i = 0; i < nominal.values.size(); ++i) {
    nominal.values[i] = get_nominal(data, nominal.unknowns[i]);
  }
  const NoiseFloors floors = calc_noise_floors(data, base.runs, base.spectra, before, threads);
  std::vector<DiagnosedRun> runs(data.run_count());
  share_large_items(threads, runs.size(), [&](std::size_t r, int inside) {
    const std::vector<TimeWindow> windows = make_time_windows(data, r);
    const auto compare = [&](const SharedValues& shared) {
      return compare_run(data, r, shared, floors[r], windows, inside);
    };
    runs[r] = {r, compare(nominal), compare(before), {}};
    runs[r].after = diagnosis.is_extended() ? compare(after) : runs[r].before;
  });
  return runs;
}

Improvement calc_improvement(const CampaignData& data, const Selection& selection,
                             const std::vector<DiagnosedRun>& runs) {
  Improvement improvement;
  Excess excess;
  for (const ChannelSums& s : sum_channels(data, runs)) {
    if (!(s.count > 0.0)) continue;
    improvement.channels.push_back(make_channel(data, s));
    const NoiseFloor floor{std::sqrt(s.floor / s.count), s.common / s.floor,
                           data.find_noise(s.channel).uncertainty,
                           s.common > 0.0 ? s.tolerance / s.common : 0.0};
    add_excess(improvement.channels.back(),
               calc_floor_tolerance(floor, static_cast<std::size_t>(s.count)), excess);
  }
  improvement.explained = calc_explained(excess);
  improvement.excess_before = excess.before;
  improvement.excess_after = excess.after;
  fill_likelihood(selection, improvement);
  return improvement;
}

bool is_improved(const Improvement& improvement) {
  constexpr double kTolerance = 0.05;  // of a floor: less is scatter
  return improvement.hold_out.is_possible() &&
         improvement.excess_after <= improvement.excess_before + kTolerance;
}

std::vector<std::string> list_worsened(const CampaignData& data,
                                       const std::vector<DiagnosedRun>& runs) {
  constexpr double kWorse = 1.05;
  std::vector<std::string> worsened;
  for (const DiagnosedRun& run : runs) {
    if (!is_held_out(data, run)) continue;
    for (std::size_t k = 0; k < run.after.channels.size() && k < run.before.channels.size(); ++k) {
      const ChannelComparison &before = run.before.channels[k], &after = run.after.channels[k];
      if (after.is_adequate() || after.rms <= kWorse * before.rms) continue;
      worsened.push_back(fmt::format("{} in {}, from {:.3g} to {:.3g} times its noise",
                                     data.info(after.channel).name, name_run(data, run.run),
                                     before.adequacy.calc_times_noise(),
                                     after.adequacy.calc_times_noise()));
    }
  }
  return worsened;
}

}  // namespace strut
