// From a case's number to its point: a level of each axis of a grid, or a sample between the
// bounds. By index, in any order, from any thread.
//
// latin_hypercube  each axis is cut into `count` cells; a keyed permutation per axis says which one
//                  a sample has, a random number where in it (M. D. McKay, R. J. Beckman, W. J.
//                  Conover, Technometrics 21, 1979)
// sobol            Boost's Sobol sequence from its first point, zero, on, every axis xored with
//                  random bits (digital shift), which keeps its evenness and removes its corner
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/math/permutation.h"
#include "sweep/request.h"

namespace strut {

/// Place `index` of `count` equal parts of an axis.
struct AxisPart {
  std::int64_t index = 0, count = 1;
};

class CasePoints {
 public:
  /// Parts into which the samples' coordinates cut an axis.
  static constexpr std::int64_t kCoordinates = std::int64_t{1} << 62;

  explicit CasePoints(const SweepRequest& request);
  ~CasePoints();
  CasePoints(CasePoints&&) noexcept;

  SampleMethod method() const { return method_; }
  const Grid& grid() const { return grid_; }
  /// Grid points, or samples.
  std::int64_t size() const;

  /// Per axis: the level of a grid point; for samples the coordinate, of kCoordinates.
  void calc_coordinates(std::int64_t id, std::span<std::int64_t> coordinates) const;
  /// One value per axis.
  void calc_values(std::int64_t id, std::span<double> values) const;
  /// The part of an axis that a case has: its level, its cell or its coordinate.
  AxisPart calc_part(std::int64_t id, std::size_t axis) const;

 private:
  struct Sobol;

  SampleMethod method_;
  Grid grid_;
  std::int64_t count_;
  std::uint64_t seed_;
  std::vector<Permutation> cells_;  // latin_hypercube: of each axis
  std::unique_ptr<const Sobol> sobol_;
};

}  // namespace strut
