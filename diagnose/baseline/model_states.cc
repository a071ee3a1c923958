#include "diagnose/baseline/model_states.h"

namespace strut {

std::vector<StateCurve> list_states(const CampaignData& data, const RunCurves& curves) {
  std::vector<StateCurve> states;
  for (const StateInfo& state : data.model().states) {
    states.push_back({&state, calc_sum(state.sum, curves.channel)});
  }
  return states;
}

}  // namespace strut
