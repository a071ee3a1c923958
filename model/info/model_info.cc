#include "model/info/model_info.h"

#include <algorithm>

namespace strut {
namespace {

template <class Named>
int find_named(const std::vector<Named>& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& one) { return one.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

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
  return find_named(model.channels, name);
}

int find_input(const ModelInfo& model, const std::string& name) {
  return find_named(model.inputs, name);
}

InputDerivative find_input_derivative(const ModelInfo& model, const std::string& channel) {
  const int input = find_input(model, channel), number = find_channel(model, channel);
  if (input >= 0 || number < 0) return {input, 0};
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    if (model.inputs[i].rate == number) return {static_cast<int>(i), 1};
    if (model.inputs[i].second_rate == number) return {static_cast<int>(i), 2};
  }
  return {};
}

}  // namespace strut
