// Tables and text of a noise study, for the terminal and the report.
#pragma once

#include <string>
#include <vector>

#include "report/figures.h"
#include "study/noise/results.h"

namespace strut {

/// One table per parameter: errors beside bounds, one row per scale.
std::vector<ReportTable> make_noise_tables(const NoiseStudy& study);

/// The result at the noise of real sensors, in one line.
std::string describe_noise_result(const NoiseStudy& study);

ReportSection make_noise_section(const NoiseStudy& study, const FigureDrawer& drawer);

}  // namespace strut
