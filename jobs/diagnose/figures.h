// Charts of a diagnosis, with captions.
#pragma once

#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "report/chart.h"

namespace strut {

/// Probabilities of causes, group, runners-up and of no effect of the catalogue; empty where
/// nothing was fitted.
std::vector<Chart> make_cause_charts(const Diagnosis& diagnosis);

/// Errors on the held-out runs before and after, beside the noise; empty without an extension.
std::vector<Chart> make_improvement_charts(const Diagnosis& diagnosis);

/// One run: measured, calibrated and extended curves over time with residuals; where there is a
/// body balance, its residual force. Empty where the calibrated model could not be simulated.
std::vector<Chart> make_run_charts(const CampaignData& data, const Diagnosis& diagnosis,
                                   const DiagnosedRun& run);

/// The force map; empty where there is none.
std::vector<Chart> make_map_charts(const Diagnosis& diagnosis);

/// Forces of spring and damper over their motion in the first held-out run, as the models have them
/// and as measured where a stand does. Empty where none could be simulated.
std::vector<Chart> make_law_charts(const CampaignData& data, const Diagnosis& diagnosis);

/// All held-out runs together: residuals over deflection and velocity. Empty where none could be
/// simulated.
std::vector<Chart> make_motion_charts(const CampaignData& data, const Diagnosis& diagnosis);

}  // namespace strut
