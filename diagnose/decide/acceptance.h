// Rules by which the best candidate of a round becomes a cause: its size in the fitted runs, and
// its confirmation by the held-out ones.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/decide/select.h"

namespace strut {

/// Whether the best candidate exceeds SelectOptions::certain times the threshold.
bool is_certain(const SelectRound& round, const SelectOptions& options);

/// Whether the best candidate exceeds the threshold, but is not stable.
bool is_unstable(const SelectRound& round, const SelectOptions& options);

/// Whether the best candidate is large enough, and stable, beside the causes of `selection`, to be
/// fitted in full.
bool is_large(const Selection& selection, const SelectRound& round, const SelectOptions& options);

/// Which candidate leads a round, with the best second effect fitted beside each. `gains`: delta
/// chi2 of these pairs, by candidate, at least one; 0 where none was fitted. The first leads,
/// unless another's pair gains 1.02 times as much, and `least` more.
std::size_t choose_lead(const std::vector<double>& gains, double least);

/// chi2 over its expectation once a fit's is lower by `gain`, at least 1.
double calc_misfit(const FitResult& fit, double gain);

/// Whether an effect of the model's file can be dropped: whether the model without it, of delta
/// chi2 `without`, is within three standard deviations, for noise as large as the residuals, of the
/// one with other values of it, of delta chi2 `changed`.
bool is_dispensable(const FitResult& now, double changed, double without);

/// Sum of chi2 over the held-out runs; larger than any other where one cannot be simulated.
double sum_chi2(const std::vector<HoldOutRun>& runs);

/// Whether the held-out runs contradict the best candidate: from `selection` to `judged`, the same
/// runs with the candidate, their chi2 rises by more than noise explains, or one cannot be
/// simulated any more.
bool is_contradicted(const Selection& selection, const SelectRound& round,
                     const std::vector<HoldOutRun>& judged);

/// Whether the held-out runs confirm the best candidate: they do not contradict it, and delta chi2
/// of all runs exceeds the threshold or, where the model's error dominates, their own chi2 falls by
/// half of dominated_share.
bool is_confirmed(const Selection& selection, const SelectRound& round,
                  const std::vector<HoldOutRun>& judged, const SelectOptions& options);

/// Whether a calibration that has not converged may serve as reference: whether its chi2 is off by
/// less than a twentieth of the causes' delta chi2, the sum of `gains`.
bool is_near_minimum(const FitResult& calibration, const std::vector<double>& gains);

/// A candidate of the last round that counts as residual.
struct Rejected {
  Refusal reason = Refusal::kNone;
  double gain = 0.0;  // delta chi2
};

/// The best candidate if it was refused; where its delta chi2 is large, one that is too small
/// beside the first cause to be one itself, or a fit whose values are not such as its effect has.
Rejected find_rejected(const Selection& selection, const SelectRound& last);

}  // namespace strut
