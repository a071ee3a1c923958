#include "diagnose/decide/judge_force_map.h"

#include <algorithm>

namespace strut {

HoldOutSum::HoldOutSum(const std::vector<HoldOutRun>& runs) {
  for (const HoldOutRun& run : runs) {
    is_whole = is_whole && run.failure.empty();
    chi2 += run.chi2;
    log_likelihood += run.log_likelihood;
    expected += run.expected;
  }
}

double HoldOutSum::calc_misfit() const { return std::max(1.0, chi2 / expected); }

double HoldOutSum::calc_log_odds(const HoldOutSum& other) const {
  return (log_likelihood - other.log_likelihood) / calc_misfit();
}

double calc_removed_share(const HoldOutSum& now, const HoldOutSum& judged) {
  constexpr double kLeast = 1e-9;  // of chi2, in place of no excess
  return std::min(1.0, (now.chi2 - judged.chi2) / std::max(now.chi2 - now.expected, kLeast));
}

bool is_map_confirmed(const HoldOutSum& now, const HoldOutSum& judged,
                      const ForceMapOptions& options) {
  return judged.is_whole && judged.calc_log_odds(now) >= options.log_odds &&
         calc_removed_share(now, judged) >= options.least_share;
}

bool explains_causes(const HoldOutSum& before, const HoldOutSum& now, const HoldOutSum& judged,
                     const ForceMapOptions& options) {
  return before.chi2 - now.chi2 <= options.causes_share * (before.chi2 - judged.chi2);
}

}  // namespace strut
