// How sensor noise limits identification: networks over a snapshot and over a window, and the fit
// of the simulation, each beside the Cramer-Rao bound of the same measurement.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "jobs/json.h"
#include "sweep/request.h"
#include "train/training_table.h"

namespace strut {

struct NoiseStudyRequest {
  std::vector<double> scales;   // of the default noise (sweep/sensor_noise.h), ascending
  double from = 0.0, to = 0.0;  // s, the window
  int copies = 8;               // noisy copies of each case that a network trains on
  int fits = 40;                // records to which the simulation is fitted, at each scale
  double hit_time = 0.005;      // s, 1 sigma, of a window's records
};

/// The data: a sweep of snapshots, whose grid has nothing but what is identified, and one of
/// histories, which may also vary the speed, a nuisance.
struct NoiseStudyData {
  SweepRequest snapshot, window;
  std::filesystem::path snapshot_data, window_data;  // what `strut run` made of them
  std::vector<std::string> inputs;                   // of the snapshot
};

/// Numbers of one parameter at one scale, in its unit: bounds are 1 sigma, errors root mean square
/// over cases that training never saw.
struct NoiseErrors {
  double snapshot_bound = 0.0, snapshot_network = 0.0;
  double window_bound = 0.0, window_network = 0.0, window_fit = 0.0;
};

struct NoisePoint {
  double scale = 1.0;
  std::vector<NoiseErrors> errors;  // per parameter
  double chi2_per_degree = 0.0;     // of the fits, mean
  double fit_seconds = 0.0;         // s of each, mean
};

struct NoiseStudy {
  std::vector<ColumnInfo> parameters;
  std::vector<double>
      spread;  // standard deviation over the cases: the error of who knows only them
  int fits = 0;
  std::vector<NoisePoint> points;  // as the request's scales
};

/// The trainings that calc_noise_study reads the models of: `like` with each noise.
std::vector<TableTraining> list_noise_trainings(const NoiseStudyRequest& request,
                                                const NoiseStudyData& data,
                                                const TrainingRequest& like);

/// Evaluates the models in `models`, fits, and computes the bounds, at the middle of the grids.
/// False once `halt` is true. The result does not depend on `threads`. Throws InputError.
bool calc_noise_study(const NoiseStudyRequest& request, const NoiseStudyData& data,
                      const std::filesystem::path& models, int threads, NoiseStudy& study,
                      std::atomic<bool>& halt);

Json make_json(const NoiseStudy& study);

}  // namespace strut
