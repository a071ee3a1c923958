// Compares a study with its aim: the number of errors within it, and the largest errors.
#pragma once

#include <string>
#include <vector>

#include "study/results.h"

namespace strut {

/// The aim: errors at most this fraction of the published number, and 1 - R2 at most the other.
inline constexpr double kAimedRatio = 0.1, kAimedR2Gap = 1e-4;

/// All cells of one preload at the sweep's own instant, by their medians over seeds.
struct StudySummary {
  std::string preload;
  std::size_t errors = 0, errors_held = 0;  // errors with a published number; those within the aim
  double median_ratio = 0.0, smallest_ratio = 0.0, largest_ratio = 0.0;  // ours / published
  std::string largest_at;               // cell, parameter and metric
  std::size_t gaps = 0, gaps_held = 0;  // values of R2; those within the aim
  double median_gap = 0.0, smallest_gap = 0.0, largest_gap = 0.0;  // 1 - R2
  std::string largest_gap_at;                                      // cell and parameter
};

/// One summary per preload.
std::vector<StudySummary> summarize(const StudyRequest& request, const StudyResults& results);

}  // namespace strut
