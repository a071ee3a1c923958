// Findings about the readings themselves: clocks, sensors at their limits, mains, copies.
#pragma once

#include <vector>

#include "estimate/measured_run.h"
#include "estimate/recording/finding.h"

namespace strut {

/// Gaps and jitter of the clocks.
std::vector<RecordingFinding> check_clocks(const std::vector<MeasuredRun>& runs);

/// Saturation, quantization and lines of the mains, each channel's worst run.
std::vector<RecordingFinding> check_sensors(const std::vector<MeasuredRun>& runs);

/// Pairs of runs, most of whose readings of a channel are the same.
std::vector<RecordingFinding> check_copies(const std::vector<MeasuredRun>& runs);

}  // namespace strut
