// Figures of a diagnosis, with captions.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "report/chart.h"

namespace strut {

/// Probabilities of causes, group, runners-up and of none of them; none where nothing was fitted.
std::vector<Chart> make_cause_charts(const Diagnosis& diagnosis);

/// Errors of the runs held out before and after, beside the noise; none without an extension.
std::vector<Chart> make_gain_charts(const Diagnosis& diagnosis);

/// One run: measured, baseline and extended curves over time with what they leave; with a body
/// balance the force that the strut lacks. Nothing where the baseline could not be simulated.
std::vector<Chart> make_run_charts(const CampaignData& data, const Diagnosis& diagnosis,
                                   const DiagnosedRun& run);

/// The force map, where there is one.
std::vector<Chart> make_map_charts(const Diagnosis& diagnosis);

/// All runs held out together: residuals over deflection and velocity; forces of spring and damper
/// over them. Nothing where none could be simulated.
std::vector<Chart> make_motion_charts(const CampaignData& data, const Diagnosis& diagnosis);

}  // namespace strut
