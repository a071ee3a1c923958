// From the files and settings on a command line to a case that can run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/car/case.h"
#include "model/kernel/simulation.h"

namespace strut {

/// What the user named, to be named again in messages.
struct CaseSource {
  std::filesystem::path vehicle;
  std::filesystem::path maneuver;     // empty: none, as for kinematics
  std::vector<std::string> settings;  // "name=value"
};

/// Reads the files and applies the settings. Throws InputError.
Case load_case(const CaseSource& source);

/// Calls a function of the model on `source`; what the model finds impossible becomes an InputError
/// that names the file and the settings.
PreparedCase prepare_case(const CaseSource& source, const Case& c);
PreparedCase prepare_case(const CaseSource& source, const Case& c, CasePreparer& preparer);
AssembledVehicle assemble_case(const CaseSource& source, const Case& c);

}  // namespace strut
