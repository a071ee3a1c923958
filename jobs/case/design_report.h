// Sensitivities and design of a sweep's measurement, as `strut design` and a sweep's report show
// them.
#pragma once

#include <string>
#include <vector>

#include "estimate/design.h"

namespace strut {

struct DesignReport {
  Sensitivity sensitivity;
  std::vector<int> channels;
  SensorNoise noise;
  Design design;
};

/// Maximum standard error of an identifiable parameter [%]: its own size.
inline constexpr double kIdentifiable = 100.0;

/// Parameters that are not identifiable by `bounds`.
std::vector<std::string> list_not_identifiable(const Sensitivity& s, const Bounds& bounds);

/// Converts per cent of a parameter to its unit.
inline double to_unit(const SensitivityParameter& p, double percent) {
  return 0.01 * p.scale * percent;
}

inline const ChannelInfo& get_channel(int channel) {
  return list_car_channels()[static_cast<std::size_t>(channel)];
}

}  // namespace strut
