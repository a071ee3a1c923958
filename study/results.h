// Results of a study: errors of every training on its test cases, medians over seeds, and the
// published numbers beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study/folder.h"
#include "study/noise/results.h"
#include "train/data/metrics.h"
#include "train/model/model_file.h"

namespace strut {

/// Median, smallest and largest value over the seeds of a cell.
struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
};

/// The median of an even number of values is the mean of the middle two. All are NaN where one
/// value is. Throws std::invalid_argument where there are no values.
Spread calc_spread(std::vector<double> values);

struct SeedResult {
  int seed = 0;
  std::string model;             // path of the file from the study's folder
  std::vector<Metrics> metrics;  // on the test cases, per parameter
  std::int64_t tested = 0;       // number of test cases
  int epochs = 0;
  StopReason stop = StopReason::kNone;
  double best_validation = 0.0, seconds = 0.0;  // values of the training
};

struct CellResult {
  StudyCell cell;
  std::string key, sweep;
  double offset = 0.0;  // m, of the snapshot
  std::vector<ColumnInfo> parameters;
  std::vector<SeedResult> seeds;
  std::vector<std::array<Spread, kMetrics.size()>> spread;  // per parameter
};

struct SweepFacts {
  std::string name, plan_hash;
  std::int64_t cases = 0, failed = 0;
  double offset = 0.0;  // m
};

struct StudyResults {
  std::vector<SweepFacts> sweeps;
  std::vector<CellResult> cells;
  std::optional<NoiseStudy> noise;
};

/// Evaluates every model of the study and reads the bounds and fits of its noise section. Throws
/// InputError where one is missing or damaged.
StudyResults read_results(const StudyFolder& folder, const StudyRequest& request);

/// The main cell of a preload.
const CellResult& find_main_cell(const StudyRequest& request, const StudyResults& results,
                                 std::size_t preload);

/// The published number of a cell's parameter for kMetrics[metric]; NaN where there is none, as for
/// all cells at the best instant.
double find_published(const StudyRequest& request, const CellResult& cell, std::size_t parameter,
                      std::size_t metric);

/// Unit of a parameter's metric: "%" (MAPE), "1" (R2), else that of the parameter.
std::string get_unit(const ColumnInfo& parameter, std::size_t metric);

}  // namespace strut
