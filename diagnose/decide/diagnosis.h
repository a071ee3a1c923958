// The whole diagnosis of a campaign: errors of the model, the effect of the catalogue that explains
// them and its probability, the improvement by the extended model on held-out runs, and the next
// measurement.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/compare/compare.h"
#include "diagnose/decide/fit_force_map.h"
#include "diagnose/decide/shared_law.h"
#include "diagnose/decide/verdict.h"
#include "diagnose/discrepancy/map_shape.h"

namespace strut {

/// A parameter of the model before and after the extension, with 95 % intervals.
struct ParameterChange {
  std::string name, unit;
  double nominal = 0.0;  // in the model's file
  double before = 0.0, before_low = 0.0, before_high = 0.0;
  double after = 0.0, after_low = 0.0, after_high = 0.0;
  bool before_at_bound = false, after_at_bound = false;  // held by a bound of its range
  /// Whether members of a group give it clearly different values; the interval after the extension
  /// contains those of all members.
  bool differs = false;
};

/// One channel over all held-out runs.
struct ChannelImprovement {
  std::string channel, unit;
  double rms_before = 0.0, rms_after = 0.0, noise_floor = 0.0;
  double nrmse_before = 0.0, nrmse_after = 0.0;  // over the measured spread
};

/// Improvement of the extended over the calibrated model on the held-out runs.
struct Improvement {
  std::vector<ChannelImprovement> channels;
  /// Fraction of the excess error that is removed: (before - after) / (before - floor) of the rms,
  /// the floor with its tolerance, summed over channels in units of their floors. Null where no
  /// channel exceeds its floor before.
  std::optional<double> explained;
  double excess_before = 0.0, excess_after = 0.0;                  // the sums over channels
  double log_likelihood_before = 0.0, log_likelihood_after = 0.0;  // per sample
  HoldOutFall hold_out;  // of chi2, twice the log odds of the extended against the calibrated model
};

/// Where the residual of the calibrated model is largest.
struct Where {
  std::string run, channel, time, band, depends_on, place;
};

/// A force of a strut that is not in the catalogue.
struct UnknownForce {
  std::string place;      // as a force map's
  ForceMap map;           // of the extended model
  VisitedStates states;   // of the strut in the runs for fitting
  MapDependence depends;  // of the map over these states
  double fraction = 0.0;  // of the held-out runs' excess over noise that the map removes
};

/// One run with the user's nominal model, the calibrated one, and the extended one; the last equals
/// the calibrated one where there is no extension.
struct DiagnosedRun {
  std::size_t run = 0;
  ModelComparison nominal, before, after;
};

struct Diagnosis {
  Verdict verdict;
  std::string sentence;  // the verdict in words
  Where where;
  std::optional<UnknownForce> force;  // of the extended model, in addition to the causes
  std::vector<ParameterChange> parameters;
  std::vector<StrutSecant> secants;  // of the extended model; empty without one
  Improvement improvement;
  std::vector<std::string> not_identifiable;
  std::string next_measurement;
  Selection selection;
  std::vector<DiagnosedRun> runs;        // all of the campaign, in its order
  std::vector<Misfit> misfits_before;    // of the calibrated model
  std::vector<PriorConflict> conflicts;  // of the extended model
  std::vector<std::string> notes;        // for the user
  /// Whether every held-out run could be simulated, and the calibration converged or is close to
  /// its minimum compared with the delta chi2 of the causes.
  bool is_whole = true;

  /// Whether there is an extended model.
  bool is_extended() const { return !verdict.positions.empty() || force.has_value(); }
};

struct DiagnoseOptions {
  int threads = 1;
  std::function<void(const std::string&)> progress;  // called with the name of each stage
};

Diagnosis diagnose_campaign(const CampaignData& data, const DiagnoseOptions& options = {});

/// The text of the model's file with the causes switched on at their fitted values, the force map,
/// and the fitted parameters. It is a model file like any other. `folder`: where the file will lie;
/// paths in the model are rewritten relative to it.
std::string make_extended_model(const CampaignData& data, const Diagnosis& diagnosis,
                                const std::filesystem::path& folder);

}  // namespace strut
