// The results of a noise study as JSON and CSV.
#pragma once

#include <string>

#include "io/format/json.h"
#include "study/noise/results.h"

namespace strut {

Json make_json(const NoiseStudy& study);

/// One row per number, with its unit.
std::string make_csv(const NoiseStudy& study);

}  // namespace strut
