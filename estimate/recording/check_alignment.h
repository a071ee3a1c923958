// Findings about signs, factors, lags, swapped and strange channels.
#pragma once

#include <vector>

#include "estimate/recording/alignment.h"
#include "estimate/recording/finding.h"

namespace strut {

std::vector<RecordingFinding> check_alignment(const std::vector<MeasuredRun>& runs,
                                              const Alignment& alignment);

}  // namespace strut
