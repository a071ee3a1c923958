// Names the causes of a selection, with probabilities and intervals, and decides on the verdict.
#pragma once

#include "diagnose/decide/diagnosis.h"

namespace strut {

/// Fills in kind, causes, group, runners-up and unknown_share from the selection and the force map.
void name_causes(const CampaignData& data, Diagnosis& diagnosis);

}  // namespace strut
