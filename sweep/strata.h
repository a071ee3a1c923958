// The strata of a sweep: their bounds, their sizes and the stratum of each case.
//
// by a parameter   grid: level i of n is in stratum floor(i strata / n); samples: equal parts of
//                  the axis
// by degradation   the mean over the axes of |1 - value / from|; strata of equal size, the cases
//                  sorted by degradation, ties by case id. Losses are summed as integers, so that
//                  equal degradations tie exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math/grid_sums.h"
#include "sweep/case_points.h"

namespace strut {

struct Stratum {
  double lower = 0.0, upper = 0.0;  // bounds of the parameter, or of the degradation
  std::int64_t population = 0;      // number of its points
  std::int64_t drawn = 0;           // number of its cases that run
};

/// The strata and the rule that assigns cases to them.
struct Strata {
  std::vector<Stratum> list;
  int axis = -1;  // index of the stratifying axis; -1: by degradation
  // By degradation only:
  std::vector<SumAxis> losses;     // weight: loss of one level; for samples, of the whole axis
  std::vector<RankedPoint> first;  // first case of each stratum but the lowest
};

/// Computes bounds and populations; `drawn` is 0. Visits every point of a sample once. Throws
/// InputError if a stratum is empty.
Strata make_strata(const SweepRequest& request, const CasePoints& points);

/// Returns the stratum of case `id`.
int calc_stratum(const Strata& strata, const CasePoints& points, std::int64_t id);

}  // namespace strut
