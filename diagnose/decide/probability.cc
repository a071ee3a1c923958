#include "diagnose/decide/probability.h"

#include <algorithm>
#include <cmath>

namespace strut {

double calc_own_probability(double share) {
  constexpr double kEven = 0.03;
  return share / (share + kEven);
}

std::vector<double> calc_log_odds(const SelectRound& round, const ProbabilityOptions& options) {
  std::vector<double> odds;
  odds.reserve(round.candidates.size());
  if (round.candidates.empty()) return odds;
  const double most = round.candidates.front().gain / round.misfit;
  const double temperature = 1.0 + options.form_error * std::max(0.0, most);
  for (const Candidate& c : round.candidates) {
    double value = 0.5 * (c.gain / round.misfit - most) / temperature;
    for (const HypothesisParameter& p : c.hypothesis.parameters) {
      if (!p.switches) value -= options.shape_cost;
    }
    if (is_corner(c.hypothesis.place)) value -= options.corner_cost;
    // Names of one class share its probability.
    value -= std::log(static_cast<double>(
        std::count_if(round.candidates.begin(), round.candidates.end(),
                      [&](const Candidate& other) { return other.alias == c.alias; })));
    odds.push_back(value);
  }
  const double best = *std::max_element(odds.begin(), odds.end());
  for (double& value : odds) value -= best;
  return odds;
}

}  // namespace strut
