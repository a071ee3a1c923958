// verdict.json: keys in docs/diagnosis.md.
#pragma once

#include "diagnose/decide/diagnosis.h"
#include "io/format/json.h"

namespace strut {

Json make_verdict_json(const CampaignData& data, const Diagnosis& diagnosis);

}  // namespace strut
