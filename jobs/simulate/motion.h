// A simulated car as a page shows it: from the side, crossing its bump, and its curves.
#pragma once

#include <array>
#include <vector>

#include "io/format/json.h"
#include "model/car/case.h"
#include "model/kernel/simulation.h"
#include "report/chart.h"

namespace strut {

/// Points of a bump's profile from end to end: x from its center, height [m]; none on a flat road.
std::vector<std::array<double, 2>> list_profile(const RoadSpec& road);

/// What report/page/motion.js draws: the motion over time [s, m, rad], where wheels and struts
/// are on the car, and the road's profile. Struts are drawn between their mounts at nominal trim,
/// shortened by their deflection. The history of `results` holds all channels of a car.
Json make_motion(const Case& c, const LaneResults& results);

/// Body, suspension, dampers and tires over time.
Chart make_motion_curves(const LaneResults& results);

}  // namespace strut
