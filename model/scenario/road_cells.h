// Cells: quintics of equal length that approximate a function within a tolerance.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "model/scenario/profile.h"
#include "model/scenario/road.h"

namespace strut {

/// Quintic through value, slope and curvature at both ends of a cell.
inline RoadCell make_cell(const Jet& a, const Jet& b, double h) {
  const double c0 = a.value, c1 = h * a.slope, c2 = 0.5 * h * h * a.curvature;
  const double d = b.value - c0 - c1 - c2;
  const double e = h * b.slope - c1 - 2.0 * c2;
  const double g = h * h * b.curvature - 2.0 * c2;
  return {{c0, c1, c2, 10.0 * d - 4.0 * e + 0.5 * g, -15.0 * d + 7.0 * e - g,
           6.0 * d - 3.0 * e + 0.5 * g, 0.0, 0.0}};
}

inline double calc_cell(const RoadCell& cell, double t) {
  const auto& c = cell.coefficient;
  return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

inline double calc_cell_slope(const RoadCell& cell, double t) {
  const auto& c = cell.coefficient;
  return c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])));
}

/// Maximum deviation of a polynomial from the function that it approximates.
struct CellTolerance {
  double value;  // m
  double slope;
};

/// Whether the cell agrees with f at the middle and the quarter points.
template <class Function>
bool is_accurate(const RoadCell& cell, const Function& f, double begin, double h,
                 const CellTolerance& tolerance) {
  for (const double t : {0.5, 0.25, 0.75}) {
    const Jet truth = f(begin + t * h);
    if (std::fabs(calc_cell(cell, t) - truth.value) > tolerance.value) return false;
    if (std::fabs(calc_cell_slope(cell, t) / h - truth.slope) > tolerance.slope) return false;
  }
  return true;
}

/// `count` equal cells over [begin, end]; empty if `checked` and a cell is not accurate.
template <class Function>
std::vector<RoadCell> fill_cells(const Function& f, double begin, double end, std::size_t count,
                                 const CellTolerance& tolerance, bool checked) {
  const double h = (end - begin) / static_cast<double>(count);
  std::vector<RoadCell> cells;
  Jet left = f(begin);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = begin + h * static_cast<double>(i);
    const Jet right = f(i + 1 == count ? end : begin + h * static_cast<double>(i + 1));
    cells.push_back(make_cell(left, right, h));
    if (checked && !is_accurate(cells.back(), f, a, h, tolerance)) return {};
    left = right;
  }
  return cells;
}

/// Equal cells over [begin, end]; their number is doubled from `count` until they are accurate, up
/// to 4096.
template <class Function>
std::vector<RoadCell> tabulate_cells(const Function& f, double begin, double end, std::size_t count,
                                     const CellTolerance& tolerance) {
  std::vector<RoadCell> cells;
  for (; cells.empty(); count *= 2) {
    cells = fill_cells(f, begin, end, count, tolerance, 2 * count <= 4096);
  }
  return cells;
}

}  // namespace strut
