// The folder of a diagnosis.
#pragma once

#include <filesystem>

#include "jobs/arguments.h"
#include "jobs/report/page_file.h"

namespace strut {

struct DiagnoseFolder : PageFolder {
  std::filesystem::path verdict() const { return root / "verdict.json"; }
  std::filesystem::path extended_model() const { return root / "extended.toml"; }
};

/// The folder of --output, made where it is missing. Throws InputError where it is missing, a file,
/// or holds a diagnosis and --force is not given; EnvironmentError where it cannot be made.
DiagnoseFolder find_diagnose_folder(const Arguments& arguments);

}  // namespace strut
