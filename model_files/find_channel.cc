#include "model_files/find_channel.h"

#include <vector>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "model/channel/car_channels.h"

namespace strut {

int find_car_channel(const std::string& name) {
  std::vector<std::string> names;
  names.reserve(list_car_channels().size());
  for (const ChannelInfo& info : list_car_channels()) {
    if (info.name == name) return static_cast<int>(names.size());
    names.push_back(info.name);
  }
  throw InputError("unknown channel '" + name + "'" + suggest_name(name, names) +
                   "; channels: " + join_names(names));
}

}  // namespace strut
