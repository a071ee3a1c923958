// The model without any extension: with the values of its file, and calibrated to the campaign.
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
  /// The fit to the runs for fitting: the shared unknowns first, then each run's own. Empty where
  /// nothing is free.
  FitResult fit;
  bool is_fitted = false;
  std::vector<std::size_t> runs;  // fitted runs

  std::size_t shared_count() const { return calibrated.unknowns.size(); }
  /// Standard error of a shared value, widened if the residuals exceed noise (FitResult::widened).
  double calc_sigma(std::size_t i) const;
};

/// Fits the parameters of `[fit] free` to the runs for fitting, together with the nuisances of
/// each. Throws InputError.
Baseline calibrate_baseline(const CampaignData& data, int threads = 1,
                            const FitOptions& options = {});

/// The campaign of a single run with the shared values set in its model and inputs, and shared
/// biases subtracted from its readings. Only the run's own unknowns remain.
CampaignData pin_run(const CampaignData& data, std::size_t run, const SharedValues& shared);

/// One run against the model at given shared values. Only the run's own unknowns are fitted to it:
/// a held-out run determines its initial state, not the model.
struct RunEvaluation {
  std::string failure;  // empty: the run was simulated
  std::vector<Unknown> unknowns;
  std::vector<double> values;  // of the run's own unknowns
  RunCurves curves;
  /// Measured less simulated, by channel of the run and time; NaN: missing.
  std::vector<std::vector<double>> residual;
};

RunEvaluation evaluate_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                           int threads = 1);

}  // namespace strut
