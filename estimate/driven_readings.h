// Runs that recorded inputs drive, against their simulation.
//
//   residual = (y_sim(t; p, x0) + b - y_measured) / sigma
//
// p: parameters, force maps and gains of the inputs; x0: initial state; b: bias of a sensor. Inputs
// and readings share a clock.
#pragma once

#include <memory>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/reading_model.h"

namespace strut {

/// Throws InputError for unusable runs or unknowns.
std::unique_ptr<ReadingModel> make_driven_readings(std::vector<MeasuredRun> runs,
                                                   std::vector<Unknown> unknowns,
                                                   const LinearizeOptions& options);

}  // namespace strut
