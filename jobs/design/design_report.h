// What `strut design` prints and writes.
#pragma once

#include <filesystem>

#include "estimate/design.h"
#include "io/format/json.h"

namespace strut {

struct DesignReport {
  Sensitivity sensitivity;
  std::vector<int> channels;
  SensorNoise noise;
  Design design;
};

/// One sigma of more than the parameter's own size says nothing about it [%].
inline constexpr double kIdentifiable = 100.0;

/// Parameters that `bounds` leave unknown in this sense.
std::vector<std::string> list_free(const Sensitivity& s, const Bounds& bounds);

/// Per cent of a parameter in its unit.
inline double to_unit(const SensitivityParameter& p, double percent) {
  return 0.01 * p.scale * percent;
}

inline const ChannelInfo& get_channel(int channel) {
  return list_car_channels()[static_cast<std::size_t>(channel)];
}

/// Tables for a person, on standard output.
void print_design(const DesignReport& report);

Json make_design_json(const DesignReport& report);

/// Columns time, offset and, for every channel with a sensor and every parameter, the channel's
/// change per per cent of the parameter. Throws EnvironmentError.
void write_design_csv(const std::filesystem::path& file, const DesignReport& report);

}  // namespace strut
