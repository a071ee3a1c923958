// Measured against simulated: every run with the nominal and the calibrated model, its residuals
// looked at from every side, and whether the model is adequate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"
#include "diagnose/baseline/body_balance.h"
#include "diagnose/baseline/residuals.h"
#include "diagnose/baseline/time_windows.h"
#include "diagnose/compare/car_balance.h"

namespace strut {

/// chi2 / n beyond which a channel shows more than its noise:
/// (1 + 2 u)^2 (1 + kAdequateSigmas sqrt(2 / n)), u the relative 1 sigma of the noise's own
/// estimate.
inline constexpr double kAdequateSigmas = 4.0;
double calc_adequate_limit(std::size_t count, double noise_uncertainty);

struct ChannelComparison {
  int channel = 0;  // of the model
  std::size_t count = 0;
  double measured_spread = 0.0;  // about the mean
  double rms = 0.0, nrmse = 0.0, mean = 0.0;
  double sigma = 0.0;             // of the noise
  double chi2_per_reading = 0.0;  // (rms / sigma)^2
  double limit = 0.0;             // of an adequate model
  double neighbor_correlation = 0.0;
  std::vector<WindowResidual> windows;
  std::vector<BandResidual> bands;
  std::vector<StateResidual> states;

  bool is_adequate() const { return chi2_per_reading <= limit; }
};

/// One run against the model at one set of shared values.
struct ModelComparison {
  RunEvaluation evaluation;
  std::vector<ChannelComparison> channels;  // none where the evaluation failed
};

struct RunComparison {
  std::size_t run = 0;
  std::vector<TimeWindow> windows;
  ModelComparison nominal, calibrated;
  // Where the channels allow, at the calibrated values; of a quarter car, of a car.
  std::optional<BodyBalance> balance;
  std::optional<CarBalance> car_balance;
};

struct Comparison {
  Baseline baseline;
  std::vector<RunComparison> runs;            // in the campaign's order
  std::vector<std::string> not_identifiable;  // combinations that the runs for fitting leave open

  /// Every channel of every run agrees with the calibrated model as far as its noise allows.
  bool is_adequate() const;
};

/// Throws InputError where the calibration cannot start; a run that cannot be simulated says so in
/// its evaluation.
Comparison compare_campaign(const CampaignData& data, int threads = 1);

/// Compares one run at given shared values: what diagnose asks again for every extension.
ModelComparison compare_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                            const std::vector<TimeWindow>& windows, int threads = 1);

}  // namespace strut
