// The data and the networks of a noise study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/study/noise_request.h"
#include "sweep/request.h"
#include "train/training_table.h"

namespace strut {

/// A sweep of snapshots, whose grid has nothing but what is identified.
struct NoiseSnapshots {
  std::string preload;
  SweepRequest sweep;
  std::filesystem::path data;  // what `strut run` made of it
};

/// What is simulated: snapshots with each preload, histories with one of them, which may also vary
/// the speed, a nuisance.
struct NoiseStudyData {
  std::vector<NoiseSnapshots> snapshots;
  std::vector<std::string> inputs;  // of the snapshots
  SweepRequest window;
  std::filesystem::path window_data;
  /// What trainings have in common with each other and the noise-free ones: network, split, seed,
  /// options.
  TrainingRequest like;
};

/// "noise_trimmed_0.1", "noise_window_0.1": of a training.
std::string make_snapshot_name(const NoiseSnapshots& snapshots, double scale);
std::string make_window_name(double scale);

TableTraining make_snapshot_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                     const NoiseSnapshots& snapshots, double scale);
TableTraining make_window_training(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                   double scale);

/// All of them, at every scale.
std::vector<TableTraining> list_noise_trainings(const NoiseStudyRequest& request,
                                                const NoiseStudyData& data);

}  // namespace strut
