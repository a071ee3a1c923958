// The data and the networks of a noise study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/noise/request.h"
#include "sweep/request.h"
#include "train/training_table.h"

namespace strut {

/// A sweep of snapshots; its grid varies the identified parameters only.
struct NoiseSnapshots {
  std::string preload;
  SweepRequest sweep;
  std::filesystem::path data;  // folder of the simulated sweep
};

/// Simulated data: snapshots with each preload, histories with one of them, whose grid may also
/// vary the speed, a nuisance.
struct NoiseStudyData {
  std::vector<NoiseSnapshots> snapshots;
  std::vector<std::string> inputs;  // channels of the snapshots
  SweepRequest window;
  std::filesystem::path window_data;
  /// Settings shared by all trainings, with and without noise: network, split, seed, options.
  TrainingRequest common;
};

/// "noise_trimmed_0.1", "noise_window_0.1": name of a training.
std::string make_snapshot_name(const NoiseSnapshots& snapshots, double scale);
std::string make_window_name(double scale);

TableTraining make_snapshot_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                     const NoiseSnapshots& snapshots, double scale);
TableTraining make_window_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   double scale);

/// The trainings of all snapshots and of the windows, scale by scale.
std::vector<TableTraining> list_noise_trainings(const NoiseStudyRequest& request,
                                                const NoiseStudyData& data);

}  // namespace strut
