// The folder of a comparison.
#pragma once

#include <filesystem>
#include <string>

#include "jobs/arguments.h"

namespace strut {

struct CompareFolder {
  std::filesystem::path root;

  std::filesystem::path json() const { return root / "compare.json"; }
  std::filesystem::path report() const { return root / "report.html"; }
  std::filesystem::path figures() const { return root / "figures"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
};

/// The folder of --output, made where it is missing. Throws InputError where it is missing, a file,
/// or holds a comparison and --force is not given; EnvironmentError where it cannot be made.
CompareFolder find_compare_folder(const Arguments& arguments);

}  // namespace strut
