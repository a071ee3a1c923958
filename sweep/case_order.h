// Which case runs at which position.
//
// A grid runs shuffled, by a keyed permutation, so that a sweep stopped at any moment is an
// unbiased sample of the whole. Where an axis changes the car's mechanism, which takes some 30 ms
// to make, or the duration, which lanes share, cases run in the grid's order with those axes
// slowest. Latin hypercube and Sobol samples run by number: every beginning of a Sobol sequence is
// even.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/math/permutation.h"
#include "sweep/case_points.h"

namespace strut {

/// Axes of a grid along which neighbors cannot share a mechanism and lanes cheaply.
std::vector<std::size_t> find_slow_axes(const SweepRequest& request);

class CaseOrder {
 public:
  /// `drawn`: the cases' numbers; nothing: all of `points`.
  CaseOrder(const SweepRequest& request, const CasePoints& points,
            std::optional<std::vector<std::int64_t>> drawn);

  std::int64_t size() const { return size_; }
  /// The drawn cases' numbers, ascending; empty where all run.
  std::vector<std::int64_t> list_drawn() const;
  std::int64_t calc_case_id(std::int64_t position) const;
  /// -1 where the case is not among them.
  std::int64_t find_position(std::int64_t case_id) const;

 private:
  std::int64_t calc_rank(std::int64_t case_id) const;
  std::int64_t calc_id(std::int64_t rank) const;

  std::int64_t points_;                               // numbers of cases there are
  std::vector<std::size_t> axes_;                     // slowest first; empty: cases rank by number
  Grid grid_, ranked_;                                // axes as asked, and in the order of axes_
  std::optional<std::vector<std::int64_t>> members_;  // ranks of the drawn cases, ascending
  std::int64_t size_;
  std::optional<Permutation> shuffle_;
};

}  // namespace strut
