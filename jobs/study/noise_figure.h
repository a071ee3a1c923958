// A noise study's figure.
#pragma once

#include "jobs/study/figures.h"
#include "jobs/study/noise_study.h"

namespace strut {

/// Errors and bounds over the noise, one panel a parameter, both axes logarithmic.
StudyFigure make_noise_figure(const NoiseStudy& study);

}  // namespace strut
