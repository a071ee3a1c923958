// What a study found: errors of every training on cases it never saw, medians over seeds, and how
// they compare with published numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/format/json.h"
#include "jobs/study/folder.h"
#include "jobs/study/noise_study.h"
#include "train/data/metrics.h"
#include "train/model/model_file.h"

namespace strut {

/// Over the seeds of a cell.
struct Spread {
  double median = 0.0, low = 0.0, high = 0.0;
};

/// Median: of an even number the mean of the middle two. All NaN where one value is. Throws
/// std::invalid_argument for none.
Spread calc_spread(std::vector<double> values);

struct SeedResult {
  int seed = 0;
  std::string model;             // file, from the study's folder
  std::vector<Metrics> metrics;  // per parameter, of the test part
  std::int64_t tested = 0;
  int epochs = 0;
  StopReason stop = StopReason::kNone;
  double best_validation = 0.0, seconds = 0.0;
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

/// Published number of a cell's parameter, `metric` of kMetrics; NaN: none. Published are numbers
/// of the sweep's own instant alone.
double find_published(const StudyRequest& request, const CellResult& cell, std::size_t parameter,
                      std::size_t metric);

/// Of a parameter's metric: its own unit, "%" (MAPE) or "1" (R2).
std::string get_unit(const ColumnInfo& parameter, std::size_t metric);

/// The aim: errors at most this share of the published number, 1 - R2 at most the other.
inline constexpr double kAimedRatio = 0.1, kAimedR2Gap = 1e-4;

/// Of all cells of one preload at the sweep's own instant, medians over seeds.
struct StudySummary {
  std::string preload;
  std::size_t errors = 0, errors_held = 0;  // numbers with a published one, and within the aim
  double median_ratio = 0.0, smallest_ratio = 0.0, largest_ratio = 0.0;  // ours / published
  std::string largest_at;
  std::size_t gaps = 0, gaps_held = 0;                             // of R2
  double median_gap = 0.0, smallest_gap = 0.0, largest_gap = 0.0;  // 1 - R2
  std::string largest_gap_at;
};

std::vector<StudySummary> summarize(const StudyRequest& request, const StudyResults& results);
std::string make_line(const StudySummary& summary);

Json make_json(const StudyRequest& request, const StudyResults& results);

/// One line a number, units beside it.
std::string make_csv(const StudyRequest& request, const StudyResults& results);

}  // namespace strut
