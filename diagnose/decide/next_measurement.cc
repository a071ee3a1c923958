#include "diagnose/decide/next_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text/format_number.h"
#include "diagnose/decide/possible_runs.h"
#include "diagnose/decide/separation.h"

namespace strut {
namespace {

/// Standard deviations below which no separation is promised.
constexpr double kPromised = 3.0;

/// A possible run by which the rivals differ by at most `bound`, not adjusted, in chi2.
struct Ranked {
  PossibleRun run;
  const NoiseSpectrum* noise = nullptr;
  double bound = 0.0;
};

/// The possible runs in which the rivals differ by as much as may be promised, largest bound first.
std::vector<Ranked> rank_possible_runs(const CampaignData& data, const WhitenedFit& fit,
                                       const Rivals& rivals) {
  std::vector<Ranked> ranked;
  for (std::size_t i = 0; i < fit.runs.size(); ++i) {
    for (PossibleRun& run : list_possible_runs(data, fit.runs[i])) {
      const double bound = bound_chi2_between(run.data, fit.spectra[i], rivals);
      if (!(bound / rivals.misfit >= kPromised * kPromised)) continue;  // NaN: cannot be simulated
      ranked.push_back({std::move(run), &fit.spectra[i], bound});
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.bound > b.bound; });
  return ranked;
}

/// Root of the sum of squares over the existing runs.
double separate_existing(const CampaignData& data, const WhitenedFit& fit, const Rivals& rivals) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fit.runs.size(); ++i) {
    const double s = calc_separation(take_run(data, fit.runs[i]), fit.spectra[i], rivals);
    if (std::isfinite(s)) sum += s * s;
  }
  return std::sqrt(sum);
}

struct BestRun {
  std::string description;
  double separation = 0.0;
};

std::optional<BestRun> find_best_run(const CampaignData& data, const WhitenedFit& fit,
                                     const Rivals& rivals) {
  constexpr std::size_t kTried = 6;  // of the largest bounds
  std::vector<Ranked> ranked = rank_possible_runs(data, fit, rivals);
  ranked.resize(std::min(ranked.size(), kTried));
  std::optional<BestRun> best;
  for (const Ranked& r : ranked) {
    const double s = calc_separation(r.run.data, *r.noise, rivals);
    if (!(s >= kPromised) || (best && s <= best->separation)) continue;
    best = BestRun{r.run.description, s};
  }
  return best;
}

std::string format_tenths(double value) { return format_rounded(std::round(10.0 * value) / 10.0); }

std::string propose_separation(const CampaignData& data, const Selection& selection,
                               const Rivals& rivals, const std::string& pair) {
  const WhitenedFit& fit = selection.extended;
  const double existing = separate_existing(data, fit, rivals);
  if (existing >= kPromised) {
    return fmt::format(
        "none is promised to separate {}: the existing runs are sensitive enough and favor "
        "neither, "
        "so neither may have the right form",
        pair);
  }
  const std::optional<BestRun> best = find_best_run(data, fit, rivals);
  if (best) {
    return fmt::format("{}: separates {} by {} standard deviations ({} in the existing runs)",
                       best->description, pair, format_tenths(best->separation),
                       format_tenths(existing));
  }
  return fmt::format(
      "no {} that the recorded runs show to be possible separates {} by {} standard deviations; "
      "add "
      "another sensor",
      data.has_inputs() ? "amplitude" : "speed or bump", pair, kPromised);
}

/// The proposal without a group to be distinguished.
std::string propose_confirmation(const CampaignData& data, const Selection& selection) {
  const std::vector<std::size_t>& runs = selection.extended.runs;
  const bool can_change = std::any_of(runs.begin(), runs.end(), [&](std::size_t run) {
    return !list_possible_runs(data, run).empty();
  });
  const char* changed = data.has_inputs() ? "amplitude" : "speed";
  if (!selection.causes.empty()) {
    return fmt::format(
        "repeat one of the held-out runs{}: the cause and its parameters should stay the same",
        can_change ? fmt::format(" at another {}", changed) : "");
  }
  if (!selection.is_left) {
    return fmt::format("none is needed for these runs; effects that appear at {} stay hidden",
                       data.has_inputs() ? "larger amplitudes" : "higher speeds or bumps");
  }
  return can_change
             ? fmt::format(
                   "repeat a run unchanged and at another {}: this shows whether the unknown cause "
                   "stays, and whether it grows with the motion",
                   changed)
             : "repeat a run unchanged: this shows whether the unknown cause stays";
}

}  // namespace

std::string propose_measurement(const CampaignData& data, const Selection& selection,
                                const std::vector<Cause>& group) {
  if (group.size() < 2) return propose_confirmation(data, selection);
  const Cause &a = group[0], &b = group[1];
  const std::string pair = fmt::format("{} from {}", describe_effect(a.effect, a.place),
                                       describe_effect(b.effect, b.place));
  const std::optional<Rivals> rivals =
      find_rivals(data, selection, a.effect, a.place, b.effect, b.place);
  return rivals ? propose_separation(data, selection, *rivals, pair) : "separate " + pair;
}

}  // namespace strut
