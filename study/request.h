// A study file: cars, networks, inputs and seeds of a table of trainings, and the published numbers
// to compare them with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/least_squares/levenberg_marquardt.h"
#include "study/noise/request.h"
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

/// A value of a vehicle's `[spring] preload`.
struct StudyPreload {
  std::string name;
  bool has_best = false;              // repeat the main cells with the snapshot at the best instant
  std::optional<double> best_offset;  // m, of that instant; none: the best of `strut design`
};

/// Published numbers of one cell: parameter -> metric -> value.
struct PublishedCell {
  std::string table;  // "Table 2"
  std::map<std::string, std::map<std::string, double>> parameters;
};

struct PublishedNumbers {
  std::string source;
  std::vector<std::string> remarks;
  std::map<std::string, PublishedCell> cells;  // by make_key()
};

struct StudyRequest {
  std::filesystem::path path, sweep;     // the study file and its sweep file
  std::filesystem::path published_path;  // empty: none
  std::string title;
  std::vector<std::string> notes;
  std::vector<StudyPreload> preloads;
  std::vector<std::int64_t> samples;
  std::vector<StudyNetwork> networks;
  std::vector<StudyInputs> inputs;
  int seeds = 5;  // number of seeds, 1, 2, ...; each decides split and start weights
  SplitChoice split;
  LevenbergMarquardtOptions options;
  PublishedNumbers published;

  /// The network and number of cases of the comparison of inputs and instants, and the inputs of
  /// the comparison of networks.
  std::size_t main_network = 0, main_samples = 0, main_inputs = 0;

  std::optional<NoiseStudyRequest> noise;
};

/// Reads `studies/*.toml` (docs/studies.md lists every key). Throws InputError with file, line,
/// key, value and what is allowed.
StudyRequest read_study(const std::filesystem::path& path);

/// One setting, trained with every seed; indices into the lists of the request.
struct StudyCell {
  std::size_t preload = 0, samples = 0, network = 0, inputs = 0;
  bool best_instant = false;
};

/// All cells, preload by preload: the networks with the main inputs, the other inputs with the main
/// network, then the main network with all inputs at the best instant.
std::vector<StudyCell> list_cells(const StudyRequest& request);

/// Whether network, number of cases and inputs are the main ones, at the sweep's own instant.
bool is_main(const StudyRequest& request, const StudyCell& cell);

/// "DNN3_2000_four": name of the cell in a table, the same for all preloads and instants.
std::string make_key(const StudyRequest& request, const StudyCell& cell);
/// "trimmed_2000", "trimmed_2000_best": name of the sweep with the cell's data.
std::string make_sweep_name(const StudyRequest& request, const StudyCell& cell);
/// "trimmed_DNN3_2000_four_best_seed2": name of a training.
std::string make_model_name(const StudyRequest& request, const StudyCell& cell, int seed);

}  // namespace strut
