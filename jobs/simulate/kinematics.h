// `strut simulate --kinematics`: suspension curves with the chassis fixed.
#pragma once

#include <filesystem>

#include "jobs/case/load_case.h"

namespace strut {

/// Writes the curves of the front-left and rear-left corner, wheel travel -100 to +100 mm in steps
/// of 2.5 mm, as CSV.
/// Throws InputError, EnvironmentError.
void write_kinematics(const CaseSource& source, const std::filesystem::path& output);

}  // namespace strut
