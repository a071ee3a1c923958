#include "diagnose/decide/acceptance.h"

#include <algorithm>
#include <numeric>

namespace strut {
namespace {

/// Fall of the held-out runs' chi2 that a candidate must exceed.
double calc_wanted_fall(const Selection& selection, const SelectRound& round,
                        const std::vector<HoldOutRun>& judged, const SelectOptions& options) {
  const WhitenedFit& now = selection.extended;
  if (now.is_dominated) {
    return 0.5 * options.dominated_share * sum_chi2(selection.hold_out_after);
  }
  double readings = 0.0;
  for (const HoldOutRun& run : judged) readings += run.expected;
  return options.hold_out_share * round.candidates.front().gain * readings /
         static_cast<double>(now.fit.degrees);
}

}  // namespace

bool is_certain(const SelectRound& round, const SelectOptions& options) {
  return round.candidates.front().gain > options.certain * round.threshold * round.misfit;
}

bool is_large(const Selection& selection, const SelectRound& round, const SelectOptions& options) {
  if (round.candidates.empty()) return false;
  const WhitenedFit& now = selection.extended;
  const Candidate& best = round.candidates.front();
  if (now.is_dominated) {
    return best.gain > options.dominated_share * now.fit.chi2 ||
           round.pair_gain > 2.0 * options.dominated_share * now.fit.chi2;
  }
  if (best.gain / round.misfit < round.threshold) return false;
  if (!is_certain(round, options) && best.stability < options.stability) return false;
  if (selection.causes.empty()) return true;
  const double share = is_certain(round, options) ? options.certain_share : options.second_share;
  return best.gain > share * selection.rounds.front().candidates.front().gain;
}

std::size_t choose_lead(const std::vector<double>& gains, double least) {
  constexpr double kBetter = 1.02;
  const auto max = std::max_element(gains.begin(), gains.end());
  const double first = gains.front();
  const bool is_better = *max >= kBetter * first && *max - first >= least;
  return is_better ? static_cast<std::size_t>(max - gains.begin()) : 0;
}

double calc_misfit(const FitResult& fit, double gain) {
  return std::max(1.0, (fit.chi2 - gain) / static_cast<double>(fit.degrees));
}

bool is_dispensable(const FitResult& now, double changed, double without) {
  constexpr double kSigmas = 3.0;
  return without >= changed - kSigmas * kSigmas * calc_misfit(now, changed);
}

double sum_chi2(const std::vector<HoldOutRun>& runs) {
  constexpr double kFailed = 1e300;
  double sum = 0.0;
  for (const HoldOutRun& run : runs) sum += run.failure.empty() ? run.chi2 : kFailed;
  return sum;
}

bool is_confirmed(const Selection& selection, const SelectRound& round,
                  const std::vector<HoldOutRun>& judged, const SelectOptions& options) {
  const bool is_whole = std::all_of(judged.begin(), judged.end(),
                                    [](const HoldOutRun& run) { return run.failure.empty(); });
  if (!is_whole) return false;
  if (!selection.extended.is_dominated && is_certain(round, options)) {
    return calc_fall(selection.hold_out_after, judged).is_possible();
  }
  const double fall = sum_chi2(selection.hold_out_after) - sum_chi2(judged);
  return fall > calc_wanted_fall(selection, round, judged, options);
}

bool is_near_minimum(const FitResult& calibration, const std::vector<double>& gains) {
  constexpr double kSmall = 0.05;
  const double taken = std::accumulate(gains.begin(), gains.end(), 0.0);
  const double unit = std::max(1.0, calibration.chi2_per_degree());
  return calibration.distance * calibration.distance * unit < kSmall * taken;
}

double calc_rejected_gain(const Selection& selection, const SelectRound& last) {
  constexpr double kLarge = 2.0;  // times the threshold
  if (last.accepted) return 0.0;
  // A first cause that was not confirmed is none; a further one would have completed the form.
  const bool is_further = !last.candidates.empty() && !selection.causes.empty();
  const double gain = std::max(is_further ? last.candidates.front().gain : 0.0, last.refused_gain);
  return gain / last.misfit > kLarge * last.threshold ? gain : 0.0;
}

}  // namespace strut
