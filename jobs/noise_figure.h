// A noise study's figure.
#pragma once

#include "jobs/noise_study.h"
#include "jobs/study_figures.h"

namespace strut {

/// Errors and bounds over the noise, one panel a parameter, both axes logarithmic.
StudyFigure make_noise_figure(const NoiseStudy& study);

}  // namespace strut
