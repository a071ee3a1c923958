// The model without any extension: as its file says, and with what the campaign lets it adjust.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/campaign_data.h"
#include "estimate/fit.h"
#include "estimate/simulate_run.h"

namespace strut {

/// Values of the unknowns that all runs share.
struct SharedValues {
  std::vector<Unknown> unknowns;
  std::vector<double> values;
};

struct Baseline {
  SharedValues nominal, calibrated;
  /// Over the runs for fitting: the shared unknowns first, then each run's own. Empty where nothing
  /// is free.
  FitResult fit;
  bool is_fitted = false;
  std::vector<std::size_t> runs;  // that were fitted

  std::size_t shared_count() const { return calibrated.unknowns.size(); }
  /// 1 sigma of a shared value, where the model leaves more than noise with that
  /// (FitResult::widened).
  double calc_sigma(std::size_t i) const;
};

/// Fits what `[fit] free` names to the runs for fitting, together with what is unknown about each
/// of them. Throws InputError.
Baseline calibrate_baseline(const CampaignData& data, int threads = 1,
                            const FitOptions& options = {});

/// The campaign of one run whose model and inputs have the shared values, biases taken off its
/// readings: what is left unknown is the run's own.
CampaignData pin_run(const CampaignData& data, std::size_t run, const SharedValues& shared);

/// One run against the model at given shared values. What is unknown about this run alone is fitted
/// to it: a run that is held out tells where it started, not what the model is like.
struct RunEvaluation {
  std::string failure;  // empty: it could be simulated
  std::vector<Unknown> unknowns;
  std::vector<double> values;  // of the run's own unknowns
  RunCurves curves;
  /// By channel of the run and time: measured less simulated; NaN: missing.
  std::vector<std::vector<double>> residual;
};

RunEvaluation evaluate_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                           int threads = 1);

}  // namespace strut
