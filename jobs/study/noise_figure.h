// A noise study's figure.
#pragma once

#include "jobs/study/figures.h"
#include "jobs/study/noise_study.h"

namespace strut {

/// Errors and bounds over the noise, one panel a parameter, both axes logarithmic.
Chart make_noise_chart(const NoiseStudy& study);

}  // namespace strut
