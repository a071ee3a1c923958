// The check of a campaign's recordings before any fit, for `strut compare --check` and as the first
// step of `compare` and `diagnose`.
#pragma once

#include <vector>

#include "diagnose/campaign/campaign_data.h"
#include "estimate/recording/check.h"
#include "io/format/json.h"

namespace strut {

/// Checks all runs; the free parameters of the campaign may move.
std::vector<RecordingFinding> check_campaign(const CampaignData& data, int threads);

/// Prints each finding as a note.
void report_findings(const std::vector<RecordingFinding>& findings);

/// Checks all runs and prints what it finds. Throws InputError where a run is a copy of another: a
/// held-out run would then judge nothing.
void check_before_fit(const CampaignData& data, int threads);

/// {"runs":, "findings": [{"kind": "sign", "run":, "channel":, "size":, "what":, "advice":}]}
Json make_check_json(const CampaignData& data, const std::vector<RecordingFinding>& findings);

}  // namespace strut
