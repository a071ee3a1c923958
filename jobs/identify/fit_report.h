// Output of an identification by fit: table and JSON.
#pragma once

#include "estimate/fit.h"
#include "identify/fit.h"
#include "io/format/json.h"

namespace strut {

/// The row's JSON and: converged, distance, at_kink, chi2_per_dof, dof, adequate, nuisances by run,
/// channels, not_identifiable, correlation, iterations, simulations, left_aside. The first
/// `parameter_count` unknowns are the parameters.
Json make_fit_json(const FitResult& fit, const std::vector<MeasuredRun>& runs,
                   std::size_t parameter_count);

/// Prints parameters and nuisances as a table to standard output; the quality of the fit and what
/// it leaves undetermined to standard error.
void print_fit(const FitResult& fit, const std::vector<MeasuredRun>& runs,
               std::size_t parameter_count);

}  // namespace strut
