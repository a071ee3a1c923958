// The output of `strut design` for other programs: JSON and CSV.
#pragma once

#include <filesystem>

#include "io/format/json.h"
#include "jobs/case/design_report.h"

namespace strut {

Json make_design_json(const DesignReport& report);

/// Writes columns time, offset and, for every channel with a sensor and every parameter, the change
/// of the channel per per cent of the parameter. Throws EnvironmentError.
void write_design_csv(const std::filesystem::path& file, const DesignReport& report);

}  // namespace strut
