// Unknowns of a campaign: free parameters, nuisances of its runs, errors of its sensors.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/campaign/campaign_data.h"

namespace strut {

/// The unknowns that all of `runs` share: those of `[fit] free`, with their priors, the gains of
/// inputs that are not known exactly and, where there are any of these, the gain errors and skews
/// of the sensors.
std::vector<Unknown> make_free_unknowns(const CampaignData& data,
                                        const std::vector<std::size_t>& runs);

/// The value of a shared unknown in the model's file.
double get_nominal(const CampaignData& data, const Unknown& unknown);

/// The nuisances of `runs` (make_nuisances), except those in `chosen`, with the priors that the
/// campaign gives for single runs. Unknown::run is an index in `runs`.
std::vector<Unknown> make_run_unknowns(const CampaignData& data,
                                       const std::vector<std::size_t>& runs,
                                       const std::vector<Unknown>& chosen);

}  // namespace strut
