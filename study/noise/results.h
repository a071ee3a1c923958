// Results of a noise study: errors of networks over a snapshot and over a window and of the fit of
// the simulation, each beside the Cramer-Rao bound of the same measurement.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/noise/trainings.h"

namespace strut {

/// Errors of one parameter at one scale, in its unit, all of them root mean squares over the test
/// cases; bounds are 1 sigma.
struct SnapshotErrors {
  double bound = 0.0, network = 0.0;
};
struct WindowErrors {
  double bound = 0.0, network = 0.0, fit = 0.0;
};
struct NoiseErrors {
  std::vector<SnapshotErrors> snapshots;  // by preload
  WindowErrors window;
};

struct NoisePoint {
  double scale = 1.0;
  std::vector<NoiseErrors> errors;  // per parameter
  std::size_t converged = 0;        // number of converged fits
  double chi2_per_degree = 0.0;     // mean over the fits
  double fit_seconds = 0.0;         // s, mean duration of a fit
};

/// A sensor with its noise at scale 1.
struct NoiseSensor {
  std::string channel, unit;
  double sigma = 0.0, bias = 0.0;  // 1 sigma per sample and per record, in `unit`
  bool in_window = false;          // false: in the snapshot
};

struct NoiseStudy {
  std::vector<ColumnInfo> parameters;
  std::vector<std::string> preloads;  // preloads of the snapshots
  std::string window_preload;
  std::vector<NoiseSensor> sensors;
  double rate = 0.0;            // 1/s, samples of the windows
  double from = 0.0, to = 0.0;  // s, of the windows
  double hit_time = 0.0;        // s, 1 sigma
  int copies = 0;
  /// Standard deviation of each parameter over the grid: the error of an estimate without sensors.
  std::vector<double> spread;
  /// Largest over smallest bound among the test cases, per parameter.
  std::vector<std::vector<double>> snapshot_variation;  // by preload, then parameter
  std::vector<double> window_variation;
  std::size_t fits = 0;            // per scale
  std::vector<NoisePoint> points;  // ascending in scale
};

/// Evaluates the models in the folder `models` and reads the bounds and fits in the folder
/// `limits`. Throws InputError where one of them is missing or damaged.
NoiseStudy read_noise_study(const NoiseStudyRequest& request, const NoiseStudyData& data,
                            const std::filesystem::path& models,
                            const std::filesystem::path& limits);

/// The point whose scale is nearest to 1, the noise of real sensors.
const NoisePoint& find_real_point(const NoiseStudy& study);

/// Largest ratios of errors to the window's bound over the parameters.
struct WindowRatios {
  double network = 0.0, fit = 0.0;
};
WindowRatios calc_window_ratios(const NoisePoint& point);

}  // namespace strut
