// The figure of a noise study.
#pragma once

#include "jobs/study/figures.h"
#include "study/noise/results.h"

namespace strut {

/// Errors and bounds over the noise, one panel a parameter, both axes logarithmic.
Chart make_noise_chart(const NoiseStudy& study);

}  // namespace strut
