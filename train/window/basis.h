// The directions in which the records of a sweep differ.
#pragma once

#include "train/data/split.h"
#include "train/window/records.h"

namespace strut {

/// Reference, mean and basis of noise-free records of the training part, their hit times drawn as
/// `noise` says, in memory for some of them:
///
///  - the reference is the training record nearest to the mean of all;
///  - the basis holds the principal directions of the aligned, whitened records whose standard
///    deviation exceeds 1, that of the noise, at most choice.components: below, a direction tells
///    more about the noise than about the car. By orthogonal iteration and a Rayleigh-Ritz step (G.
///    H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., 8.2.4, 8.7.2), which passes over the
///    records and never holds their covariance.
///
/// Throws InputError where a record agrees with the reference only at the end of the lags, and
/// where no direction exceeds the noise.
WindowTransform make_window_transform(const WindowRecords& records, const Split& split,
                                      const NoiseModel& noise, const WindowChoice& choice,
                                      const RowStoreOptions& store);

}  // namespace strut
