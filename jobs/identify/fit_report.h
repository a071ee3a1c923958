// What a fit found, printed and as JSON.
#pragma once

#include "estimate/fit.h"
#include "jobs/identify/result.h"

namespace strut {

/// The unknowns that were asked for, not the nuisances; the half width is 1.96 sigma, infinite
/// where the parameter is not identifiable.
IdentifiedRow make_fit_row(const FitResult& fit, std::size_t parameter_count);

/// The row's JSON and: converged, distance, at_kink, chi2_per_dof, dof, adequate, nuisances by run,
/// channels, not_identifiable, correlation, iterations, simulations, left_aside. The first
/// `parameter_count` unknowns are the parameters.
Json make_fit_json(const FitResult& fit, const std::vector<MeasuredRun>& runs,
                   std::size_t parameter_count);

/// Parameters and nuisances as a table to standard output; how good the fit is, and what it leaves
/// open, to standard error.
void print_fit(const FitResult& fit, const std::vector<MeasuredRun>& runs,
               std::size_t parameter_count);

}  // namespace strut
