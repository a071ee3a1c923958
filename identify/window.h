// Identification by a network over windows of time histories.
#pragma once

#include "identify/identified.h"
#include "identify/record.h"
#include "train/model/identifier.h"

namespace strut {

/// Identifies the parameters from a record. It is outside of the training range if a component
/// exceeds its range by more than the noise, if the directions of the training do not span it
/// ("leftover"), or if it aligns with the reference only at an end of the allowed shifts
/// ("alignment"). Values are then given only with `extrapolate`.
IdentifiedRow identify_record(const TrainedModel& model, const Identifier& identifier,
                              const MeasuredRecord& record, bool extrapolate);

}  // namespace strut
