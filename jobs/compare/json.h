// compare.json: keys in docs/diagnosis.md.
#pragma once

#include "diagnose/compare/compare.h"
#include "io/format/json.h"

namespace strut {

Json make_compare_json(const CampaignData& data, const Comparison& comparison);

}  // namespace strut
