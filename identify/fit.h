// Identification by fitting the simulation of a car to measured runs: its unknowns and its results.
#pragma once

#include <string>
#include <vector>

#include "estimate/fit.h"
#include "identify/identified.h"

namespace strut {

/// Makes the unknowns of the parameters in `names`; the speed has one value per run, other
/// parameters one for all runs. Throws InputError where a name is unknown or given twice.
std::vector<Unknown> make_free_unknowns(const std::vector<MeasuredRun>& runs,
                                        const std::vector<std::string>& names);

/// Sets the prior of the unknowns called `name`, and their initial guess to its mean within the
/// bounds. Throws InputError where there is no such unknown.
void set_prior(const ModelInfo& model, const std::string& name, const Prior& prior,
               std::vector<Unknown>& unknowns);

/// Adds the parameter `name` to the unknowns as a nuisance with a prior, which is also its scale:
/// it may be known from the prior alone. One that is a nuisance already, as the speed, only gets
/// the prior. Throws InputError where the name is unknown.
void add_nuisance(const std::vector<MeasuredRun>& runs, const std::string& name, const Prior& prior,
                  std::vector<Unknown>& unknowns);

/// Makes the estimate of unknown `i`: half width 1.96 sigma, infinite where it is not identifiable;
/// not in range where it is not identifiable or held by a bound.
IdentifiedParameter make_estimate(const FitResult& fit, std::size_t i);

/// Makes the estimates of the first `parameter_count` unknowns, which precede the nuisances.
IdentifiedRow make_fit_row(const FitResult& fit, std::size_t parameter_count);

}  // namespace strut
