// A simulated car as a page shows it: from the side, crossing its bump, and its curves.
#pragma once

#include "jobs/json.h"
#include "jobs/report/chart.h"
#include "model/kernel/simulation.h"
#include "model/vehicle/case.h"

namespace strut {

/// What jobs/report/page/motion.js draws: the motion over time [s, m, rad], where wheels and struts
/// are on the car, and the road's profile. Struts are drawn between their mounts at nominal trim,
/// shortened by their deflection. The history of `results` holds all channels of a car.
Json make_motion(const Case& c, const LaneResults& results);

/// Body, suspension, dampers and tires over time.
Chart make_motion_curves(const LaneResults& results);

}  // namespace strut
