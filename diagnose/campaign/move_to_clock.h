// Channels of one recording with different sampling rates.
#pragma once

#include <vector>

namespace strut {

/// Returns a channel that was sampled at `own_times` at the samples of another clock, `times`, both
/// ascending; NaN: no reading. Values between two of the channel's own samples are interpolated
/// linearly.
///  - An input has a value at every time between its first and its last sample.
///  - An output keeps as many readings as it has: each of its samples, if `times` is faster, moves
///    to the nearest time, where no more than half an interval lies between.
std::vector<double> move_to_clock(const std::vector<double>& own_times,
                                  const std::vector<double>& values,
                                  const std::vector<double>& times, bool is_input);

}  // namespace strut
