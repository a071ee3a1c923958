// One entry of a table of channels.
#pragma once

#include <string>

namespace strut {

/// A reported quantity: ISO 8855 axes, SI units.
struct ChannelInfo {
  std::string name, unit, description;
  bool is_given = false;  // time, and a recorded input with its derivatives
};

}  // namespace strut
