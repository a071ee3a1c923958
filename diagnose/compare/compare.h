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
#include "diagnose/compare/adequacy.h"
#include "diagnose/compare/car_balance.h"

namespace strut {

struct ChannelComparison {
  int channel = 0;  // index in ModelInfo::channels
  std::size_t count = 0;
  double measured_spread = 0.0;  // about the mean
  double rms = 0.0, nrmse = 0.0, mean = 0.0;
  double sigma = 0.0;             // of the sensor's noise
  double chi2_per_reading = 0.0;  // (rms / sigma)^2
  double limit = 0.0;             // of chi2_per_reading: max of an adequate model
  ChannelAdequacy adequacy;
  double neighbor_correlation = 0.0;
  std::vector<WindowResidual> windows;
  std::vector<BandResidual> bands;
  std::vector<StateResidual> states;

  bool is_adequate() const { return adequacy.is_adequate(); }
};

/// One run against the model at one set of shared values.
struct ModelComparison {
  RunEvaluation evaluation;
  std::vector<ChannelComparison> channels;  // empty where the evaluation failed
  std::vector<PriorConflict> conflicts;     // of the run's own values
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
  std::vector<Misfit> misfits;                // of the calibrated model, by run and channel
  std::vector<PriorConflict> conflicts;       // of the calibrated model
  std::vector<std::string> notes;             // for the user

  /// Whether every channel of every run agrees with the calibrated model within its noise.
  bool is_adequate() const { return misfits.empty(); }
};

/// Throws InputError where the calibration cannot start. A run that cannot be simulated has a
/// failure in its evaluation.
Comparison compare_campaign(const CampaignData& data, int threads = 1);

/// Compares one run at given shared values; `floors`: by channel of the run.
ModelComparison compare_run(const CampaignData& data, std::size_t run, const SharedValues& shared,
                            const std::vector<NoiseFloor>& floors,
                            const std::vector<TimeWindow>& windows, int threads = 1);

/// Adds the misfits of a model in one run.
void add_misfits(const CampaignData& data, std::size_t run, const ModelComparison& model,
                 std::vector<Misfit>& misfits);
/// Adds the conflicts that contradict a model.
void add_misfits(const CampaignData& data, const std::vector<PriorConflict>& conflicts,
                 std::vector<Misfit>& misfits);

}  // namespace strut
