// The order in which cases run.
//
// A grid is shuffled by a keyed permutation, so that a sweep stopped at any moment is an unbiased
// sample of the whole. Where an axis changes the mechanism (about 30 ms to build) or the duration
// (common to all lanes of a batch), cases run in the grid's order instead, with those axes slowest.
// Latin hypercube and Sobol samples run by number: every prefix of a Sobol sequence is evenly
// distributed.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/math/permutation.h"
#include "sweep/case_points.h"

namespace strut {

/// Axes of a grid along which neighboring cases differ in mechanism or duration.
std::vector<std::size_t> find_slow_axes(const SweepRequest& request);

class CaseOrder {
 public:
  /// `drawn`: ids of the cases that run; without it, all of `points` run.
  CaseOrder(const SweepRequest& request, const CasePoints& points,
            std::optional<std::vector<std::int64_t>> drawn);

  std::int64_t size() const { return size_; }
  /// Ids of the drawn cases, ascending; empty if all run.
  std::vector<std::int64_t> list_drawn() const;
  std::int64_t calc_case_id(std::int64_t position) const;
  /// -1 if the case does not run.
  std::int64_t find_position(std::int64_t case_id) const;

 private:
  std::int64_t calc_rank(std::int64_t case_id) const;
  std::int64_t calc_id(std::int64_t rank) const;

  std::int64_t points_;                               // number of possible cases
  std::vector<std::size_t> axes_;                     // slowest first; empty: cases rank by id
  Grid grid_, ranked_;                                // axes as requested, and in order of axes_
  std::optional<std::vector<std::int64_t>> members_;  // ranks of the drawn cases, ascending
  std::int64_t size_;
  std::optional<Permutation> shuffle_;
};

}  // namespace strut
