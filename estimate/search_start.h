// Where a fit begins, if the model's own values may be far off.
#pragma once

#include <vector>

#include "estimate/reading_model.h"

namespace strut {

struct SearchOptions {
  int draws = 64;      // points tried
  int survivors = 2;   // of which a few steps are taken
  int steps = 6;       // each
  double reach = 4.0;  // of a parameter, up and down, as a factor
};

/// The best of several beginnings: the unknowns' own start and points drawn around it, parameters
/// and gains times log-uniform factors of at most `reach` (gains of either sign), all else as it
/// is; each judged by chi2, the best after a few steps of the fit. Where such steps from the own
/// start explain the readings, nothing else is tried. A simulation that is fitted over tens of
/// periods has many minima; from nominal values alone it ends in one of them. Numbers are drawn by
/// counter, so the same always come.
std::vector<double> search_start(ReadingModel& model, const SearchOptions& options = {});

}  // namespace strut
