// What a study file asks of its noise section: how much noise, which window, how many fits.
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
  std::filesystem::path sweep;  // of the histories, `window_sweep`
  WindowChoice window;
  std::vector<double> scales;  // of the default noise (estimate/sensor_noise.h), ascending
  int copies = 8;           // noisy copies of each case that a network trains on and is judged by
  int fits = 40;            // records to which the simulation is fitted, at each scale
  double hit_time = 0.005;  // s, 1 sigma, of a window's records
  std::size_t network = 0;  // of the study's
};

/// What a noise section is read beside.
struct NoiseSurroundings {
  const SweepRequest& sweep;               // of the snapshots
  const std::vector<std::string>& inputs;  // channels of the snapshot that are looked at
  const std::vector<std::string>& networks;
  std::size_t main_network = 0;
};

/// Reads `[noise]` (docs/studies.md lists every key). Throws InputError with file, line, key, value
/// and what is allowed; also where the second sweep cannot stand beside the first.
NoiseStudyRequest read_noise_request(const Table& table, const NoiseSurroundings& around);

/// Names of a grid's axes.
std::vector<std::string> list_axes(const SweepRequest& sweep);
/// Names of the channels that histories hold.
std::vector<std::string> list_history_channels(const SweepRequest& sweep);

/// The noise of snapshots: white, `scale` times the default, without biases.
NoiseModel make_snapshot_noise(const NoiseStudyRequest& request,
                               const std::vector<std::string>& channels, double scale);
/// The noise of windows: white, `scale` times the default; biases and the hit time are those of a
/// real sensor whatever the scale.
NoiseModel make_window_noise(const NoiseStudyRequest& request,
                             const std::vector<std::string>& channels, double scale);

}  // namespace strut
