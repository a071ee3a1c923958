// How sensor noise limits identification: networks over a snapshot and over a window, and the fit
// of the simulation, each beside the Cramer-Rao bound of the same measurement.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/format/json.h"
#include "jobs/study/noise_trainings.h"

namespace strut {

/// Numbers of one parameter at one scale, in its unit: bounds are 1 sigma, root mean square over
/// test cases, as the errors are.
struct SnapshotErrors {
  double bound = 0.0, network = 0.0;
};
struct WindowErrors {
  double bound = 0.0, network = 0.0, fit = 0.0;
};
struct NoiseErrors {
  std::vector<SnapshotErrors> snapshots;  // by preloads
  WindowErrors window;
};

struct NoisePoint {
  double scale = 1.0;
  std::vector<NoiseErrors> errors;  // per parameter
  std::size_t converged = 0;        // of the fits
  double chi2_per_degree = 0.0;     // of the fits, mean
  double fit_seconds = 0.0;         // s of each, mean
};

/// A sensor, with its noise at scale 1.
struct NoiseSensor {
  std::string channel, unit;
  double sigma = 0.0, bias = 0.0;  // 1 sigma of a sample, of a record
  bool in_window = false;          // else in the snapshot
};

struct NoiseStudy {
  std::vector<ColumnInfo> parameters;
  std::vector<std::string> preloads;  // of the snapshots
  std::string window_preload;
  std::vector<NoiseSensor> sensors;
  double rate = 0.0, from = 0.0, to = 0.0, hit_time = 0.0;  // 1/s, s; of the windows
  int copies = 0;
  /// Standard deviation of each parameter over the cases: the error of who knows only their grid.
  std::vector<double> spread;
  /// Per parameter, largest over smallest bound among the test cases: by preloads, of the window.
  std::vector<std::vector<double>> snapshot_variation;
  std::vector<double> window_variation;
  std::size_t fits = 0;            // at each scale
  std::vector<NoisePoint> points;  // ascending in scale
};

/// Evaluates the models in `models` and reads the bounds and fits in `limits`. Throws InputError
/// where one of them is missing or damaged.
NoiseStudy read_noise_study(const NoiseStudyRequest& request, const NoiseStudyData& data,
                            const std::filesystem::path& models,
                            const std::filesystem::path& limits);

/// The point with the scale nearest to 1: real sensors.
const NoisePoint& find_real_point(const NoiseStudy& study);

/// Largest ratios to the window's bound over the parameters.
struct WindowRatios {
  double network = 0.0, fit = 0.0;
};
WindowRatios calc_window_ratios(const NoisePoint& point);

Json make_json(const NoiseStudy& study);

/// One line a number, units beside it.
std::string make_csv(const NoiseStudy& study);

}  // namespace strut
