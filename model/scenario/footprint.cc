// Gauss quadrature of quintic patches times a cubic B-spline, split at every knot and patch.
#include "model/scenario/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "model/scenario/road_cells.h"

namespace strut {
namespace {

/// Bisects [begin, end] until quintics are accurate to 1e-13 m.
void add_patches(const std::function<Jet(double)>& f, double begin, double end, int depth,
                 Patchwork& patches) {
  const double h = end - begin;
  const RoadCell cell = make_cell(f(begin), f(end), h);
  if (depth > 0 && !is_accurate(cell, f, begin, h, {1e-13, 1e300})) {
    const double middle = 0.5 * (begin + end);
    add_patches(f, begin, middle, depth - 1, patches);
    add_patches(f, middle, end, depth - 1, patches);
    return;
  }
  patches.begins.push_back(begin);
  patches.cells.push_back(cell);
}

/// Centered cubic B-spline of unit spacing and unit integral, with two derivatives.
Jet calc_kernel(double t) {
  const double side = t < 0.0 ? -1.0 : 1.0, a = std::fabs(t), b = 2.0 - a;
  if (a >= 2.0) return {};
  if (a >= 1.0) return {b * b * b / 6.0, -0.5 * side * b * b, b};
  return {2.0 / 3.0 + a * a * (0.5 * a - 1.0), side * a * (1.5 * a - 2.0), 3.0 * a - 2.0};
}

/// Gauss-Legendre on [0, 1], 5 points: exact to degree 9; quintic times cubic has 8.
constexpr std::array<double, 5> kGaussPoint{0.046910077030668004, 0.23076534494715845, 0.5,
                                            0.76923465505284155, 0.95308992296933200};
constexpr std::array<double, 5> kGaussWeight{0.11846344252809454, 0.23931433524968324,
                                             0.28444444444444444, 0.23931433524968324,
                                             0.11846344252809454};

/// Integral of patch(u) kernel((x - u) / a) / a over [begin, end], inside one patch and one span of
/// the kernel, and its derivatives by x.
void add_patch_integral(const RoadCell& cell, double cell_begin, double cell_length, double begin,
                        double end, double x, double a, Jet& sum) {
  for (std::size_t i = 0; i < kGaussPoint.size(); ++i) {
    const double u = begin + (end - begin) * kGaussPoint[i];
    const double weight = (end - begin) / a * kGaussWeight[i];
    const double part = weight * calc_cell(cell, (u - cell_begin) / cell_length);
    const Jet kernel = calc_kernel((x - u) / a);
    sum.value += part * kernel.value;
    sum.slope += part * kernel.slope / a;
    sum.curvature += part * kernel.curvature / (a * a);
  }
}

}  // namespace

Patchwork make_patchwork(const std::vector<Branch>& envelope) {
  Patchwork patches;
  for (const Branch& branch : envelope) {
    add_patches(branch.calc, branch.begin, branch.end, 14, patches);
  }
  patches.begins.push_back(envelope.back().end);
  return patches;
}

Jet calc_average(const Patchwork& patches, double a, double x) {
  Jet sum;
  const std::vector<double>& begins = patches.begins;
  const auto above = std::upper_bound(begins.begin(), begins.end(), x - 2.0 * a);
  std::size_t i =
      above == begins.begin() ? 0 : static_cast<std::size_t>(above - begins.begin()) - 1;
  for (; i < patches.cells.size() && begins[i] < x + 2.0 * a; ++i) {
    for (int span = -2; span < 2; ++span) {
      const double begin = std::max(begins[i], x + a * span);
      const double end = std::min(begins[i + 1], x + a * (span + 1));
      if (end <= begin) continue;
      add_patch_integral(patches.cells[i], begins[i], begins[i + 1] - begins[i], begin, end, x, a,
                         sum);
    }
  }
  return sum;
}

}  // namespace strut
