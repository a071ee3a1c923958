#include "diagnose/decide/acceptance.h"

#include <algorithm>
#include <numeric>

namespace strut {
namespace {

bool are_simulated(const std::vector<HoldOutRun>& judged) {
  return std::all_of(judged.begin(), judged.end(),
                     [](const HoldOutRun& run) { return run.failure.empty(); });
}

}  // namespace

bool is_certain(const SelectRound& round, const SelectOptions& options) {
  return round.candidates.front().gain > options.certain * round.threshold * round.misfit;
}

bool is_unstable(const SelectRound& round, const SelectOptions& options) {
  const Candidate& best = round.candidates.front();
  return best.gain / round.misfit >= round.threshold && !is_certain(round, options) &&
         best.stability < options.stability;
}

bool is_large(const Selection& selection, const SelectRound& round, const SelectOptions& options) {
  if (round.candidates.empty()) return false;
  const WhitenedFit& now = selection.extended;
  const Candidate& best = round.candidates.front();
  if (now.is_dominated) {
    return best.gain > options.dominated_share * now.fit.chi2 ||
           round.pair_gain > 2.0 * options.dominated_share * now.fit.chi2;
  }
  if (best.gain / round.misfit < round.threshold || is_unstable(round, options)) return false;
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

bool is_contradicted(const Selection& selection, const SelectRound& round,
                     const std::vector<HoldOutRun>& judged) {
  const std::vector<HoldOutRun>& before = selection.hold_out_after;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].failure.empty() && !judged[i].failure.empty()) return true;
  }
  return !calc_fall(before, judged, round.misfit).is_possible();
}

bool is_confirmed(const Selection& selection, const SelectRound& round,
                  const std::vector<HoldOutRun>& judged, const SelectOptions& options) {
  if (!are_simulated(judged) || is_contradicted(selection, round, judged)) return false;
  const double before = sum_chi2(selection.hold_out_after), fall = before - sum_chi2(judged);
  if (selection.extended.is_dominated) return fall > 0.5 * options.dominated_share * before;
  return round.candidates.front().gain + fall >= round.threshold * round.misfit;
}

bool is_near_minimum(const FitResult& calibration, const std::vector<double>& gains) {
  constexpr double kSmall = 0.05;
  const double taken = std::accumulate(gains.begin(), gains.end(), 0.0);
  const double unit = std::max(1.0, calibration.chi2_per_degree());
  return calibration.distance * calibration.distance * unit < kSmall * taken;
}

Rejected find_rejected(const Selection& selection, const SelectRound& last) {
  constexpr double kLarge = 2.0;  // times the threshold
  if (last.accepted) return {};
  const double first = last.candidates.empty() ? 0.0 : last.candidates.front().gain;
  if (last.refusal != Refusal::kNone) return {last.refusal, first};
  // A further cause that is too small beside the first would have completed its form.
  const double further = selection.causes.empty() ? 0.0 : first;
  const double gain = std::max(further, last.refused_gain);
  if (gain / last.misfit <= kLarge * last.threshold) return {};
  return {further >= last.refused_gain ? Refusal::kSmall : Refusal::kImplausible, gain};
}

}  // namespace strut
