// Output of an identification by fit: table and JSON.
#pragma once

#include <cstddef>
#include <vector>

#include "estimate/fit.h"
#include "identify/fit.h"
#include "io/format/json.h"

namespace strut {

/// A fit with what it was fitted to.
struct Fit {
  std::vector<MeasuredRun> runs;
  FitResult result;
  std::size_t parameter_count = 0;  // number of parameters, which precede the nuisances
};

/// The JSON of `row`, the fit's parameters, and: converged, distance, at_kink, chi2_per_dof, dof,
/// adequate, nuisances by run, channels, not_identifiable, correlation, iterations, simulations,
/// left_aside.
Json make_fit_json(const Fit& fit, const IdentifiedRow& row);

/// Prints parameters and nuisances as a table, and the wear, to standard output; report_fit.
void print_fit(const Fit& fit, const IdentifiedRow& row);

/// Prints the quality of the fit and what it leaves undetermined to standard error.
void report_fit(const Fit& fit);

}  // namespace strut
