#include "diagnose/baseline/model_states.h"

#include <string>

namespace strut {
namespace {

using Values = std::vector<double>;

const Values& at(const RunCurves& curves, int channel) {
  return curves.channel[static_cast<std::size_t>(channel)];
}

/// a * first + b * second
Values combine(double a, const Values& first, double b, const Values& second) {
  Values sum(first.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a * first[i] + b * second[i];
  return sum;
}

std::vector<StateCurve> list_rig_states(RigKind kind, const RunCurves& curves) {
  using Q = QuarterCarChannel;
  switch (kind) {
    case RigKind::kQuarterCar:
      return {
          {"suspension_deflection", "m",
           combine(1.0, at(curves, Q::kUnsprungPosition), -1.0, at(curves, Q::kSprungPosition))},
          {"suspension_velocity", "m/s",
           combine(1.0, at(curves, Q::kUnsprungVelocity), -1.0, at(curves, Q::kSprungVelocity))},
          {"tire_load", "N", at(curves, Q::kTireForce)}};
    case RigKind::kStrutRig:
      return {{"displacement", "m", at(curves, StrutRigChannel::kDisplacement)},
              {"velocity", "m/s", at(curves, StrutRigChannel::kVelocity)}};
    case RigKind::kSingleMass:
      break;
  }
  return {{"position", "m", at(curves, SingleMassChannel::kPosition)},
          {"velocity", "m/s", at(curves, SingleMassChannel::kVelocity)}};
}

std::vector<StateCurve> list_car_states(const RunCurves& curves) {
  using C = CarChannel;
  constexpr struct {
    int channel;
    const char* name;
    const char* unit;
  } kStates[] = {{C::kSuspensionDeflection, "suspension_deflection", "m"},
                 {C::kSuspensionVelocity, "suspension_velocity", "m/s"},
                 {C::kTireForceZ, "tire_load", "N"}};
  std::vector<StateCurve> states;
  states.reserve(2 * std::size(kStates));
  for (int axle = 0; axle < kAxles; ++axle) {
    const int left = C::kCornerBegin + 2 * axle * C::kCornerChannels;
    const int right = left + C::kCornerChannels;
    for (const auto& state : kStates) {
      states.push_back(
          {std::string(axle == kFront ? "front_" : "rear_") + state.name, state.unit,
           combine(0.5, at(curves, left + state.channel), 0.5, at(curves, right + state.channel))});
    }
  }
  return states;
}

}  // namespace

std::vector<StateCurve> list_states(const CampaignData& data, const RunCurves& curves) {
  return data.is_rig() ? list_rig_states(*data.campaign.rig, curves) : list_car_states(curves);
}

}  // namespace strut
