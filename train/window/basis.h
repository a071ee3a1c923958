// Finds the directions in which the records of a sweep differ.
#pragma once

#include "train/data/split.h"
#include "train/window/records.h"

namespace strut {

/// Computes reference, mean and basis from the noise-free records of the training part, with hit
/// times drawn from `noise`:
///
///  - the reference is the training record nearest to the mean of all;
///  - the basis holds the principal directions of the aligned, whitened records whose standard
///    deviation exceeds 1, that of the noise, at most choice.components: other directions contain
///    more noise than information about the car. Computed by orthogonal iteration and a
///    Rayleigh-Ritz step (G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., 8.2.4, 8.7.2),
///    in passes over the records that never hold their covariance.
///
/// Memory does not depend on the number of records. Throws InputError if a record agrees best with
/// the reference at an end of the lags, or if no direction exceeds the noise.
WindowTransform make_window_transform(const WindowRecords& records, const Split& split,
                                      const NoiseModel& noise, const WindowChoice& choice,
                                      const RowStoreOptions& store);

}  // namespace strut
