#include "diagnose/baseline/visited_states.h"

#include <algorithm>
#include <cmath>

#include "base/math/spread.h"

namespace strut {
namespace {

using Values = std::vector<double>;

void append(const Values& from, std::size_t stride, Values& into) {
  for (std::size_t i = 0; i < from.size(); i += stride) into.push_back(from[i]);
}

VisitedStates& find_place(std::vector<VisitedStates>& states, const std::string& place) {
  const auto found = std::find_if(states.begin(), states.end(),
                                  [&](const VisitedStates& s) { return s.place == place; });
  return found != states.end() ? *found : states.emplace_back(VisitedStates{place, {}, {}, 0.0});
}

/// Drops samples that were not simulated.
void drop_missing(VisitedStates& s) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < s.deflection.size(); ++i) {
    if (!std::isfinite(s.deflection[i]) || !std::isfinite(s.velocity[i])) continue;
    s.deflection[kept] = s.deflection[i];
    s.velocity[kept++] = s.velocity[i];
  }
  s.deflection.resize(kept);
  s.velocity.resize(kept);
}

}  // namespace

std::string VisitedStates::describe() const {
  return place.empty() ? "strut" : place + " suspension";
}

std::vector<VisitedStates> list_visited_states(const CampaignData& data,
                                               const std::vector<std::size_t>& runs,
                                               const SharedValues& shared) {
  constexpr std::size_t kMaxSamples = 6000;
  std::size_t samples = 0;
  for (const std::size_t r : runs) samples += data.times(r).size();
  const std::size_t stride = 1 + samples / kMaxSamples;
  std::vector<VisitedStates> states;
  for (const std::size_t r : runs) {
    const RunCurves curves = simulate_motion(data.runs[r], shared.unknowns, shared.values);
    if (!curves.failure.empty()) continue;
    for (const StrutInfo& strut : data.model().struts) {
      VisitedStates& s = find_place(states, strut.place);
      append(calc_sum(strut.deflection, curves.channel), stride, s.deflection);
      append(calc_sum(strut.velocity, curves.channel), stride, s.velocity);
      const auto force = static_cast<std::size_t>(strut.damper_force);
      s.force = std::max(s.force, calc_spread(curves.channel[force]));
    }
  }
  for (VisitedStates& s : states) drop_missing(s);
  return states;
}

}  // namespace strut
