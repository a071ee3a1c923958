// What a study file asks for: which cars, networks, inputs and seeds, and whose numbers to stand
// beside.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/least_squares/levenberg_marquardt.h"
#include "jobs/study/noise_request.h"
#include "train/data/dataset_source.h"
#include "train/data/metrics.h"

namespace strut {

struct StudyNetwork {
  std::string name;
  std::vector<int> hidden;
};

struct StudyInputs {
  std::string name;
  std::vector<std::string> channels;
};

/// One way to hold the springs, a value of a vehicle's `[spring] preload`.
struct StudyPreload {
  std::string name;
  bool has_best = false;              // also with the snapshot at its best place
  std::optional<double> best_offset;  // m; none: as `strut design` finds it
};

/// Names of the columns of a table of errors, and where Metrics keeps them.
struct MetricInfo {
  const char* name;
  double Metrics::*value;
};
inline constexpr std::array<MetricInfo, 5> kMetrics = {
    {{"ME", &Metrics::largest_error},
     {"MAE", &Metrics::mean_absolute_error},
     {"MAPE", &Metrics::mean_absolute_percentage},
     {"RMSE", &Metrics::rms_error},
     {"R2", &Metrics::r2}}};
/// Positions in kMetrics.
inline constexpr std::size_t kMae = 1, kMape = 2, kRmse = 3, kR2 = 4;

/// Published numbers of one cell: parameter -> metric -> value.
struct PublishedCell {
  std::string table;  // "Table 2"
  std::map<std::string, std::map<std::string, double>> parameters;
};

struct PublishedNumbers {
  std::string source;
  std::vector<std::string> remarks;
  std::map<std::string, PublishedCell> cells;  // by StudyCell::key()
};

struct StudyRequest {
  std::filesystem::path path, sweep;     // the files it was read from
  std::filesystem::path published_path;  // empty: none
  std::string title;
  std::vector<std::string> notes;
  std::vector<StudyPreload> preloads;
  std::vector<std::int64_t> samples;
  std::vector<StudyNetwork> networks;
  std::vector<StudyInputs> inputs;
  int seeds = 5;  // 1, 2, ... of split and start weights
  SplitChoice split;
  LevenbergMarquardtOptions options;
  PublishedNumbers published;

  // Of which inputs and instants are compared; the tables of networks take these inputs.
  std::size_t main_network = 0, main_samples = 0, main_inputs = 0;

  std::optional<NoiseStudyRequest> noise;
};

/// Reads `studies/*.toml` (docs/studies.md lists every key). Throws InputError with file, line,
/// key, value and what is allowed.
StudyRequest read_study(const std::filesystem::path& path);

/// One setting, trained with every seed. Numbers are positions in the request's lists.
struct StudyCell {
  std::size_t preload = 0, samples = 0, network = 0, inputs = 0;
  bool best_instant = false;
};

/// All cells, preload by preload: the networks with the main inputs, the other inputs with the main
/// network, then what is repeated at the best instant.
std::vector<StudyCell> list_cells(const StudyRequest& request);

bool is_main(const StudyRequest& request, const StudyCell& cell);

/// "DNN3_2000_four": of the cell in a table, whatever preload and instant.
std::string make_key(const StudyRequest& request, const StudyCell& cell);
/// "trimmed_2000", "trimmed_2000_best": of the sweep that has the cell's data.
std::string make_sweep_name(const StudyRequest& request, const StudyCell& cell);
/// "trimmed_DNN3_2000_four_best_seed2": of a training.
std::string make_model_name(const StudyRequest& request, const StudyCell& cell, int seed);

}  // namespace strut
