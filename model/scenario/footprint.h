// Average of the disc envelope over the contact patch.
#pragma once

#include <vector>

#include "model/scenario/envelope.h"

namespace strut {

/// Cells of different lengths that cover the disc envelope.
struct Patchwork {
  std::vector<double> begins;  // m, then the end of the last cell
  std::vector<RoadCell> cells;
};

/// Bisects each branch until quintics are accurate to 1e-13 m; requires at least one branch.
Patchwork make_patchwork(const std::vector<Branch>& envelope);

/// Average of the patchwork at x [m] with the cubic B-spline kernel, a [m] a quarter of the
/// footprint: integral of patchwork(u) kernel((x - u) / a) / a, exact but for rounding.
Jet calc_average(const Patchwork& patches, double a, double x);

}  // namespace strut
