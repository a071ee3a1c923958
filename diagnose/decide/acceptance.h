// Rules by which the best candidate of a round becomes a cause: its size in the fitted runs, and
// its confirmation by the held-out ones.
#pragma once

#include <vector>

#include "diagnose/decide/select.h"

namespace strut {

/// Whether the best candidate exceeds SelectOptions::certain times the threshold.
bool is_certain(const SelectRound& round, const SelectOptions& options);

/// Whether the best candidate is large enough, beside the causes of `selection`, to be fitted in
/// full.
bool is_large(const Selection& selection, const SelectRound& round, const SelectOptions& options);

/// Sum of chi2 over the held-out runs; larger than any other where one cannot be simulated.
double sum_chi2(const std::vector<HoldOutRun>& runs);

/// Whether the held-out runs confirm the best candidate: whether their chi2 falls by enough from
/// that of `selection` to that of `judged`, the same runs with the candidate.
bool is_confirmed(const Selection& selection, const SelectRound& round,
                  const std::vector<HoldOutRun>& judged, const SelectOptions& options);

/// Whether the best candidate of the last round, too small beside the first cause to be one itself,
/// is so large that its chi2 counts as residual.
bool is_residual(const Selection& selection, const SelectRound& last);

}  // namespace strut
