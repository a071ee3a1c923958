// compare.json: keys in docs/diagnosis.md.
#pragma once

#include "diagnose/compare/compare.h"
#include "io/format/json.h"

namespace strut {

/// By channel: sigma, quantum, source.
Json make_noise(const CampaignData& data);

/// By name: gain errors and skews of the sensors, with intervals and tolerances.
Json make_sensor_errors(const FitResult& fit);

Json make_compare_json(const CampaignData& data, const Comparison& comparison);

}  // namespace strut
