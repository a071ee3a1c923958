// Measured against simulated: every run with the nominal and the calibrated model, its residuals by
// time, frequency and state, and whether the model is adequate.
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

/// Maximum chi2 / n of an adequate channel: (1 + 2 u)^2 (1 + kAdequateSigmas sqrt(2 / n)), u:
/// relative standard error of the estimated noise.
inline constexpr double kAdequateSigmas = 4.0;
double calc_adequate_limit(std::size_t count, double noise_uncertainty);

struct ChannelComparison {
  int channel = 0;  // index in ModelInfo::channels
  std::size_t count = 0;
  double measured_spread = 0.0;  // about the mean
  double rms = 0.0, nrmse = 0.0, mean = 0.0;
  double sigma = 0.0;             // of the noise
  double chi2_per_reading = 0.0;  // (rms / sigma)^2
  double limit = 0.0;             // max of an adequate model
  double neighbor_correlation = 0.0;
  std::vector<WindowResidual> windows;
  std::vector<BandResidual> bands;
  std::vector<StateResidual> states;

  bool is_adequate() const { return chi2_per_reading <= limit; }
};

/// One run against the model at one set of shared values.
struct ModelComparison {
  RunEvaluation evaluation;
  std::vector<ChannelComparison> channels;  // empty where the evaluation failed
};

struct RunComparison {
  std::size_t run = 0;
  std::vector<TimeWindow> windows;
  ModelComparison nominal, calibrated;
  // At the calibrated values, where the channels allow: for a quarter car, and for a car.
  std::optional<BodyBalance> balance;
  std::optional<CarBalance> car_balance;
};

struct Comparison {
  Baseline baseline;
  std::vector<RunComparison> runs;            // in the campaign's order
  std::vector<std::string> not_identifiable;  // combinations that the runs do not identify

  /// Whether every channel of every run agrees with the calibrated model within its noise.
  bool is_adequate() const;
};

/// Throws InputError where the calibration cannot start. A run that cannot be simulated has a
/// failure in its evaluation.
Comparison compare_campaign(const CampaignData& data, int threads = 1);

/// Compares one run at given shared values.
ModelComparison compare_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                            const std::vector<TimeWindow>& windows, int threads = 1);

}  // namespace strut
