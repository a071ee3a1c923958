// A noise study as people read it, in the terminal and in the report.
#pragma once

#include <string>
#include <vector>

#include "jobs/study/noise_study.h"
#include "report/figures.h"

namespace strut {

/// A table a parameter: errors beside bounds, scale by scale.
std::vector<ReportTable> make_noise_tables(const NoiseStudy& study);

/// What comes out of it, in one line.
std::string make_noise_line(const NoiseStudy& study);

ReportSection make_noise_section(const NoiseStudy& study, const FigureDrawer& drawer);

}  // namespace strut
