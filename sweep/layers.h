// Which layer (stratum) a case belongs to, and how many cases each has.
//
// by a parameter   grid: level i of n is in layer floor(i strata / n); samples: equal parts of the
//                  axis
// by degradation   the mean over the axes of |1 - value / from|; layers of equal count, the cases
//                  sorted by it, equal ones by case id. Sums are of integers, so that they tie
//                  exactly where the losses do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/math/grid_sums.h"
#include "sweep/case_points.h"

namespace strut {

/// One stratum.
struct Layer {
  double lower = 0.0, upper = 0.0;  // of the parameter, or of the degradation
  std::int64_t population = 0;      // points of the grid in it
  std::int64_t drawn = 0;
};

class LayerRule {
 public:
  /// Visits every point of a sample once. Throws InputError where a layer is empty.
  LayerRule(const SweepRequest& request, const CasePoints& points);

  int calc_layer(std::int64_t id) const;
  /// `drawn` is 0.
  const std::vector<Layer>& layers() const { return layers_; }

 private:
  void set_parameter_layers(const SweepRequest& request);
  void set_degradation_layers(const SweepRequest& request);
  /// Sets losses_; returns the degradation of one unit of their sum.
  double set_losses();
  std::vector<RankedPoint> find_points(const std::vector<std::int64_t>& ranks) const;
  RankedPoint rank_case(std::int64_t id) const;

  const CasePoints& points_;
  std::vector<Layer> layers_;
  int axis_ = -1;  // -1: by degradation
  // By degradation:
  std::vector<SumAxis> losses_;     // weight: of one level; of samples, of the whole axis
  std::vector<RankedPoint> first_;  // of each layer but the lowest
};

}  // namespace strut
