// A simulated car on a page: views from the side and along its axles, and curves over time.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/names/corners.h"
#include "io/format/json.h"
#include "model/car/case.h"
#include "model/kernel/simulation.h"
#include "report/chart.h"

namespace strut {

/// Points (x from the center, height) [m] of a bump's profile from end to end; none for a flat
/// road.
std::vector<std::array<double, 2>> list_profile(const RoadSpec& road);

/// Another run over the same time, of a simulation or measured: drawn over the first one.
struct OtherRun {
  std::string name;           // "worn.h5"
  std::vector<double> times;  // s
  /// Values [SI] at the times by number of the car's channel; those that its file has.
  std::map<int, std::vector<double>> channels = {};

  /// nullptr: its file does not have the channel.
  const std::vector<double>* find(int channel) const;
  /// Samples per second; nullopt where they are not even.
  std::optional<double> find_rate() const;
};

/// Reads the channels of another run from a file of any format. Throws InputError without times or
/// the body's height or acceleration.
OtherRun read_other_run(const std::filesystem::path& file);

/// The scene that report/page/motion.js draws: the motion over time [s, m, rad], the positions of
/// wheels and struts on the car, and the road under both tracks. Struts are drawn between their
/// mounts at nominal trim, shortened by their deflection. The history of `results` holds all
/// channels of a car.
Json make_motion(const Case& c, const LaneResults& results, const std::optional<OtherRun>& other);

/// Motion of body and suspension, forces of dampers and tires, over time.
Chart make_motion_curves(const LaneResults& results, const std::optional<OtherRun>& other);

}  // namespace strut
