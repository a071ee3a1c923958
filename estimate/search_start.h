// Initial guess of a fit for models whose own values may be far off.
#pragma once

#include <vector>

#include "estimate/reading_model.h"

namespace strut {

struct SearchOptions {
  int draws = 64;      // number of random points
  int survivors = 2;   // number of points refined by the fit, the best by chi2
  int steps = 6;       // of the fit for each refined point
  double reach = 4.0;  // max factor on a parameter, up and down
};

/// Returns the best of several initial guesses: the unknowns' own and points drawn around it, with
/// parameters and gains multiplied by log-uniform factors of at most `reach` (gains of either
/// sign). Points are ranked by chi2, the best of them again after a few steps of the fit. If such
/// steps from the unknowns' own guess explain the readings, no points are drawn. A simulation
/// fitted over tens of periods has many local minima, and a fit from nominal values alone ends in
/// one of them. Deterministic: random numbers depend on a counter only.
std::vector<double> search_start(ReadingModel& model, const SearchOptions& options = {});

}  // namespace strut
