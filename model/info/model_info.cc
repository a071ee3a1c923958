#include "model/info/model_info.h"

#include <algorithm>

namespace strut {

std::vector<double> calc_sum(const ChannelSum& sum,
                             const std::vector<std::vector<double>>& channel) {
  std::vector<double> values = channel[static_cast<std::size_t>(sum.front().channel)];
  for (double& value : values) value *= sum.front().factor;
  for (std::size_t k = 1; k < sum.size(); ++k) {
    const std::vector<double>& more = channel[static_cast<std::size_t>(sum[k].channel)];
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += sum[k].factor * more[i];
  }
  return values;
}

int find_channel(const ModelInfo& model, const std::string& name) {
  const auto found = std::find_if(model.channels.begin(), model.channels.end(),
                                  [&](const ChannelInfo& info) { return info.name == name; });
  return found == model.channels.end() ? -1 : static_cast<int>(found - model.channels.begin());
}

}  // namespace strut
