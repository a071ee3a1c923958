#include "diagnose/baseline/visited_states.h"

#include <algorithm>
#include <cmath>

#include "diagnose/campaign/spread.h"
#include "model/channel/car_channels.h"

namespace strut {
namespace {

using Values = std::vector<double>;

/// sign * (first - second); without a second first alone.
struct Difference {
  int first, second;
  double sign;

  Values calc(const RunCurves& curves) const {
    Values values = curves.channel[static_cast<std::size_t>(first)];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (second >= 0) values[i] -= curves.channel[static_cast<std::size_t>(second)][i];
      values[i] *= sign;
    }
    return values;
  }
};

/// Where a strut's states are found among a model's channels.
struct StrutChannels {
  std::string place;
  Difference deflection, velocity;
  int force;
};

std::vector<StrutChannels> list_rig_struts(RigKind kind) {
  constexpr int kNone = -1;
  using Q = QuarterCarChannel;
  using S = StrutRigChannel;
  using M = SingleMassChannel;
  switch (kind) {
    case RigKind::kQuarterCar:
      return {{"",
               {Q::kUnsprungPosition, Q::kSprungPosition, 1.0},
               {Q::kUnsprungVelocity, Q::kSprungVelocity, 1.0},
               Q::kDamperForce}};
    case RigKind::kStrutRig:
      return {{"", {S::kDisplacement, kNone, 1.0}, {S::kVelocity, kNone, 1.0}, S::kDamperForce}};
    case RigKind::kSingleMass:
      break;
  }
  // Compressed as the mass comes down.
  return {{"", {M::kPosition, kNone, -1.0}, {M::kVelocity, kNone, -1.0}, M::kDamperForce}};
}

std::vector<StrutChannels> list_car_struts() {
  constexpr int kNone = -1;
  using C = CarChannel;
  std::vector<StrutChannels> struts;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int begin = C::kCornerBegin + corner * C::kCornerChannels;
    struts.push_back({corner < 2 ? "front" : "rear",
                      {begin + C::kSuspensionDeflection, kNone, 1.0},
                      {begin + C::kSuspensionVelocity, kNone, 1.0},
                      begin + C::kDamperForce});
  }
  return struts;
}

void append(const Values& from, std::size_t stride, Values& into) {
  for (std::size_t i = 0; i < from.size(); i += stride) into.push_back(from[i]);
}

VisitedStates& find_place(std::vector<VisitedStates>& states, const std::string& place) {
  const auto found = std::find_if(states.begin(), states.end(),
                                  [&](const VisitedStates& s) { return s.place == place; });
  return found != states.end() ? *found : states.emplace_back(VisitedStates{place, {}, {}, 0.0});
}

/// Those of which any is not simulated leave.
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
  constexpr std::size_t kMost = 6000;
  const std::vector<StrutChannels> struts =
      data.is_rig() ? list_rig_struts(*data.campaign.rig) : list_car_struts();
  std::size_t samples = 0;
  for (const std::size_t r : runs) samples += data.times(r).size();
  const std::size_t stride = 1 + samples / kMost;
  std::vector<VisitedStates> states;
  for (const std::size_t r : runs) {
    const RunCurves curves = simulate_run(data, r, shared.unknowns, shared.values);
    if (!curves.failure.empty()) continue;
    for (const StrutChannels& strut : struts) {
      VisitedStates& s = find_place(states, strut.place);
      append(strut.deflection.calc(curves), stride, s.deflection);
      append(strut.velocity.calc(curves), stride, s.velocity);
      const double spread = calc_spread(curves.channel[static_cast<std::size_t>(strut.force)]);
      s.force = std::max(s.force, spread);
    }
  }
  for (VisitedStates& s : states) drop_missing(s);
  return states;
}

}  // namespace strut
