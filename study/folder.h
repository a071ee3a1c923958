// The folder of a study: its request, sweeps, models and results.
#pragma once

#include <filesystem>
#include <string>

#include "io/store/sweep_folder.h"
#include "study/request.h"
#include "sweep/plan.h"

namespace strut {

struct StudyFolder {
  std::filesystem::path root;

  std::filesystem::path study() const { return root / "study.toml"; }
  std::filesystem::path published() const { return root / "published.toml"; }
  /// The base sweep's request with copies of its files, and the requests derived from it.
  SweepFolder base() const { return {root / "base"}; }
  /// The same of the noise section's sweep.
  SweepFolder window_base() const { return {root / "window_base"}; }
  std::filesystem::path sweeps() const { return root / "sweeps"; }
  SweepFolder sweep(const std::string& name) const { return {sweeps() / name}; }
  std::filesystem::path models() const { return root / "models"; }
  std::filesystem::path figures() const { return root / "figures"; }
  /// Bounds and fits of the noise section.
  std::filesystem::path noise() const { return root / "noise"; }
  std::filesystem::path results() const { return root / "results.json"; }
  std::filesystem::path tables() const { return root / "tables.csv"; }
  std::filesystem::path noise_table() const { return root / "noise.csv"; }
  std::filesystem::path report() const { return root / "report.html"; }

  std::filesystem::path model(const std::string& name) const { return models() / (name + ".h5"); }
};

/// Makes the folder of a study with copies of every file it names, study.toml last. Making the same
/// study again changes nothing. Throws InputError where `root` holds a different study (the message
/// lists the changes) or other files, EnvironmentError where it cannot be written.
StudyFolder make_study_folder(const std::filesystem::path& root, const StudyRequest& request);

/// Reads the study of a folder. Throws InputError where the folder holds none.
StudyRequest open_study_folder(const StudyFolder& folder);

/// Plans the sweep of a cell, or opens its plan: the base sweep with the cell's preload, number of
/// cases and instant. Throws InputError, EnvironmentError.
Plan plan_study_sweep(const StudyFolder& folder, const StudyRequest& request,
                      const StudyCell& cell);

/// The sweep of the noise section's windows, with the last of the preloads.
SweepFolder get_window_sweep(const StudyFolder& folder, const StudyRequest& request);
/// Plans the sweep of get_window_sweep, or opens its plan.
Plan plan_window_sweep(const StudyFolder& folder, const StudyRequest& request);

/// Names of all sweeps, each with the first cell that needs it, in the order of the cells.
std::vector<std::pair<std::string, StudyCell>> list_study_sweeps(const StudyRequest& request);

}  // namespace strut
