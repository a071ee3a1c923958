// A simulated car on a page: a side view of the car crossing its bump, and curves over time.
#pragma once

#include <array>
#include <vector>

#include "io/format/json.h"
#include "model/car/case.h"
#include "model/kernel/simulation.h"
#include "report/chart.h"

namespace strut {

/// Points (x from the center, height) [m] of a bump's profile from end to end; none for a flat
/// road.
std::vector<std::array<double, 2>> list_profile(const RoadSpec& road);

/// The scene that report/page/motion.js draws: the motion over time [s, m, rad], the positions of
/// wheels and struts on the car, and the profile of the road. Struts are drawn between their mounts
/// at nominal trim, shortened by their deflection. The history of `results` holds all channels of a
/// car.
Json make_motion(const Case& c, const LaneResults& results);

/// Motion of body and suspension, forces of dampers and tires, over time.
Chart make_motion_curves(const LaneResults& results);

}  // namespace strut
