// The `[noise]` section of a study file: noise levels, window, number of fits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "io/format/toml_document.h"
#include "sweep/request.h"
#include "train/data/noise.h"
#include "train/window/records.h"

namespace strut {

struct NoiseStudyRequest {
  std::filesystem::path sweep;  // sweep file of the histories, key `window_sweep`
  WindowChoice window;
  std::vector<double> scales;  // factors of the default noise (estimate/sensor_noise.h), ascending
  int copies = 8;              // noisy copies of each case, for training and testing
  int fits = 40;               // records at each scale to which the simulation is fitted
  double hit_time = 0.005;     // s, 1 sigma of a window's hit time
  std::size_t network = 0;     // index into the study's networks
};

/// The parts of a study that its noise section depends on.
struct NoiseContext {
  const SweepRequest& sweep;               // sweep of the snapshots
  const std::vector<std::string>& inputs;  // main inputs: channels of the snapshot
  const std::vector<std::string>& networks;
  std::size_t main_network = 0;
};

/// Reads `[noise]` (docs/studies.md lists every key). Throws InputError with file, line, key, value
/// and what is allowed, also where the sweep of the windows does not match that of the snapshots.
NoiseStudyRequest read_noise_request(const Table& table, const NoiseContext& context);

/// Names of a grid's axes.
std::vector<std::string> list_axes(const SweepRequest& sweep);
/// Names of the recorded channels of a sweep's snapshots and histories.
std::vector<std::string> list_snapshot_channels(const SweepRequest& sweep);
std::vector<std::string> list_history_channels(const SweepRequest& sweep);

/// Noise of snapshots: white, `scale` times the default, no biases.
NoiseModel make_snapshot_noise(const NoiseStudyRequest& request,
                               const std::vector<std::string>& channels, double scale);
/// Noise of windows: white, `scale` times the default; biases and hit time are those of real
/// sensors at every scale.
NoiseModel make_window_noise(const NoiseStudyRequest& request,
                             const std::vector<std::string>& channels, double scale);

}  // namespace strut
