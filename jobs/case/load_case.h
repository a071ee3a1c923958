// Makes a case from the files and settings on a command line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/car/case.h"
#include "model/kernel/simulation.h"

namespace strut {

/// The files and settings that the user named; messages repeat them.
struct CaseSource {
  std::filesystem::path vehicle;
  std::filesystem::path maneuver;     // empty: none (kinematics)
  std::vector<std::string> settings;  // "name=value"
};

/// Reads the files and applies the settings. Throws InputError.
Case load_case(const CaseSource& source);

/// Functions of the model; a ModelError becomes an InputError that names file and settings of
/// `source`.
PreparedCase prepare_case(const CaseSource& source, const Case& c);
PreparedCase prepare_case(const CaseSource& source, const Case& c, CasePreparer& preparer);
AssembledVehicle assemble_case(const CaseSource& source, const Case& c);

}  // namespace strut
