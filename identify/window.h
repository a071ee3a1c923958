// Identification by a network over windows of time histories.
#pragma once

#include "identify/identified.h"
#include "identify/record.h"
#include "train/model/identifier.h"

namespace strut {

/// Identifies the parameters from a record. Outside of the range trained on are a component beyond
/// its range by more than the noise, a record that the directions of the training do not span
/// ("leftover"), and one that agrees with the reference only at its end ("alignment"). Values are
/// then given with `extrapolate` only.
IdentifiedRow identify_record(const TrainedModel& model, const Identifier& identifier,
                              const MeasuredRecord& record, bool extrapolate);

}  // namespace strut
