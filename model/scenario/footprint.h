// Average of the disc envelope over the contact patch.
#pragma once

#include <vector>

#include "model/scenario/envelope.h"

namespace strut {

/// Cells of different length that cover the disc envelope.
struct Patchwork {
  std::vector<double> begins;  // m, and the end of the last
  std::vector<RoadCell> cells;
};

/// Halves each branch until a quintic is good to 1e-13 m; at least one branch.
Patchwork make_patchwork(const std::vector<Branch>& envelope);

/// Average of the patchwork at x [m] with the cubic B-spline kernel, a [m] a quarter of the
/// footprint: integral of patchwork(u) kernel((x - u) / a) / a, exact but for rounding.
Jet calc_average(const Patchwork& patches, double a, double x);

}  // namespace strut
