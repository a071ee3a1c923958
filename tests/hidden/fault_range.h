// Faults as a kit can have them: their magnitudes, and their places in words.
#pragma once

#include <string>
#include <utility>

#include "tests/hidden/noise.h"

namespace strut::hidden {

/// Start value of a search for the magnitude: a fault that anyone would notice.
double get_start(const Kit& kit, const FaultInfo& info);

/// Fraction of it that is near the detection limit.
inline constexpr double kSmall = 0.05;

/// Min and max magnitude of a fault's search.
std::pair<double, double> find_bracket(const Kit& kit, Fault fault);

/// Largest reading of a saturating sensor in the runs for fitting, on a smooth road; 0 for other
/// faults.
double find_peak(const Kit& kit, const Truth& truth, const FaultSetting& setting);

/// The place of a fault as in a vehicle file: an axle, "body", "road", a channel; "" where a stand
/// has only one.
std::string get_place(const Kit& kit, const FaultSetting& setting);

/// The place of a fault as in a verdict's where.place: as above, and on a stand "strut", "tire",
/// "body" or "road".
std::string get_where(const Kit& kit, const FaultSetting& setting);

}  // namespace strut::hidden
