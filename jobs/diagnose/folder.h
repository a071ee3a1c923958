// The folder of a diagnosis.
#pragma once

#include <filesystem>
#include <string>

#include "jobs/arguments.h"

namespace strut {

struct DiagnoseFolder {
  std::filesystem::path root;

  std::filesystem::path verdict() const { return root / "verdict.json"; }
  std::filesystem::path extended_model() const { return root / "extended.toml"; }
  std::filesystem::path report() const { return root / "report.html"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
};

/// The folder of --output, made where it is missing. Throws InputError where it is missing, a file,
/// or holds a diagnosis and --force is not given; EnvironmentError where it cannot be made.
DiagnoseFolder find_diagnose_folder(const Arguments& arguments);

}  // namespace strut
