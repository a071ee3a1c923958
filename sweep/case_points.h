// Maps a case id to its point: one level per axis of a grid, or a sample between the bounds. Random
// access by id, safe from any thread.
//
// latin_hypercube  each axis is divided into `count` cells; a keyed permutation per axis assigns a
//                  cell to each sample, a random number its offset in the cell (M. D. McKay, R. J.
//                  Beckman, W. J. Conover, Technometrics 21, 1979)
// sobol            Boost's Sobol sequence, including its first point, zero; every axis is XORed
//                  with random bits (digital shift), which keeps the sequence even and moves its
//                  first point off the corner
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/math/permutation.h"
#include "sweep/request.h"

namespace strut {

/// Part `index` of `count` equal parts of an axis.
struct AxisPart {
  std::int64_t index = 0, count = 1;
};

class CasePoints {
 public:
  /// Resolution of a sample's coordinate: equal parts of an axis.
  static constexpr std::int64_t kCoordinates = std::int64_t{1} << 62;

  explicit CasePoints(const SweepRequest& request);
  ~CasePoints();
  CasePoints(CasePoints&&) noexcept;

  SampleMethod method() const { return method_; }
  const Grid& grid() const { return grid_; }
  /// Number of grid points, or of samples.
  std::int64_t size() const;

  /// Writes per axis the level of a grid point, or the coordinate of a sample in [0, kCoordinates).
  void calc_coordinates(std::int64_t id, std::span<std::int64_t> coordinates) const;
  /// Writes one value per axis.
  void calc_values(std::int64_t id, std::span<double> values) const;
  /// The part of an axis that holds a case: its level, its cell or its coordinate.
  AxisPart calc_part(std::int64_t id, std::size_t axis) const;

 private:
  struct Sobol;

  SampleMethod method_;
  Grid grid_;
  std::int64_t count_;
  std::uint64_t seed_;
  std::vector<Permutation> cells_;  // latin_hypercube: one per axis
  std::unique_ptr<const Sobol> sobol_;
};

}  // namespace strut
