// The check of a campaign's recordings before any fit, for `strut compare --check` and as the first
// step of `compare` and `diagnose`.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/campaign_data.h"
#include "estimate/recording/check.h"
#include "io/format/json.h"

namespace strut {

/// Checks all runs; the free parameters of the campaign may move.
std::vector<RecordingFinding> check_campaign(const CampaignData& data, int threads);

/// Prints each finding as a note.
void report_findings(const std::vector<RecordingFinding>& findings);

/// Checks all runs, prints what it finds and adds it to the notes of `data`. Returns how many
/// mistakes it found. Throws InputError where a held-out run is a copy of one for fitting: it would
/// judge nothing.
std::size_t check_before_fit(CampaignData& data, int threads);

/// After a result or an error in spite of such mistakes: says that they come first, and what to
/// call.
void suggest_correction(std::size_t mistakes, const std::string& campaign);

/// {"runs":, "findings": [{"kind": "sign", "run":, "channel":, "size":, "what":, "advice":}]}
Json make_check_json(const CampaignData& data, const std::vector<RecordingFinding>& findings);

}  // namespace strut
