// The check of recordings before any fit: mistakes of signs, units and clocks, and sensors at their
// limits.
#pragma once

#include <vector>

#include "estimate/recording/finding.h"
#include "estimate/unknown.h"

namespace strut {

/// Compares the runs with simulations in which the parameters among the unknowns `free` move as far
/// as the shapes of the channels demand (estimate/recording/alignment.h), and looks at the readings
/// themselves:
///  - sign: most runs agree better with the negative channel;
///  - factor: above 1.9 or below 1 / 1.9, beyond what wear does;
///  - lag: 10 ms or more of a channel against the others, 15 ms or more of all of them; of a motion
///  that repeats itself at most an eighth of its period;
///  - swapped: two channels, of which each agrees better with the simulation of the other;
///  - no agreement: a channel of a rig, or all of a car, that resembles nothing the model does;
///  - clock: intervals of 1.5 medians or more, beyond the jitter; jitter of a tenth of the interval
///  or more;
///  - saturation: plateaus at the largest or smallest reading that cut off a motion;
///  - quantization: steps above a tenth of the channel's standard deviation;
///  - mains: a line at 50 or 60 Hz or its double, well above its surroundings and the noise;
///  - copies: two runs, most of whose readings are the same.
/// Runs that cannot be simulated are checked by their readings alone.
std::vector<RecordingFinding> check_recordings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<Unknown>& free, int threads = 1);

}  // namespace strut
