// The output of `strut design`: tables, JSON and CSV.
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

/// Prints tables on standard output.
void print_design(const DesignReport& report);

Json make_design_json(const DesignReport& report);

/// Writes columns time, offset and, for every channel with a sensor and every parameter, the change
/// of the channel per per cent of the parameter. Throws EnvironmentError.
void write_design_csv(const std::filesystem::path& file, const DesignReport& report);

}  // namespace strut
