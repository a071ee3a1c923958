#include "model_files/find_channel.h"

#include <fmt/format.h>

#include <vector>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "model/car/car_info.h"
#include "model/channel/car_channels.h"

namespace strut {

int require_channel(const ModelInfo& model, const std::string& name) {
  const int found = find_channel(model, name);
  if (found >= 0) return found;
  std::vector<std::string> names;
  names.reserve(model.channels.size());
  for (const ChannelInfo& info : model.channels) names.push_back(info.name);
  throw InputError(fmt::format("unknown channel '{}'{}; channels: {}", name,
                               suggest_name(name, names), join_names(names)));
}

int find_car_channel(const std::string& name) { return require_channel(get_car_info(), name); }

}  // namespace strut
