// Figures of a diagnosis, with captions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnose/diagnosis.h"
#include "jobs/report/figure.h"

namespace strut {

using CaptionedFigure = std::pair<Figure, std::string>;

/// One run: measured, baseline and extended curves over time with what they leave; with a body
/// balance the force that the strut lacks. Nothing where the baseline could not be simulated.
std::vector<CaptionedFigure> make_run_figures(const CampaignData& data, const Diagnosis& diagnosis,
                                              const DiagnosedRun& run);

/// The force map, where there is one.
std::vector<CaptionedFigure> make_map_figures(const Diagnosis& diagnosis);

/// All runs held out together: residuals over deflection and velocity; forces of spring and damper
/// over them. Nothing where none could be simulated.
std::vector<CaptionedFigure> make_motion_figures(const CampaignData& data,
                                                 const Diagnosis& diagnosis);

}  // namespace strut
