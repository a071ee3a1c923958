// Makes the model of a fit's readings, for cars and rigs alike.
#pragma once

#include <memory>
#include <vector>

#include "estimate/linearize_options.h"
#include "estimate/reading_model.h"

namespace strut {

/// The readings of `runs`, all of one kind of model, against their simulation. Throws InputError
/// for unusable runs or unknowns.
std::unique_ptr<ReadingModel> make_readings(std::vector<MeasuredRun> runs,
                                            std::vector<Unknown> unknowns,
                                            const LinearizeOptions& options);

}  // namespace strut
