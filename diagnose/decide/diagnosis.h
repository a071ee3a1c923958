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
#include "diagnose/decide/select.h"
#include "diagnose/discrepancy/map_shape.h"

namespace strut {

enum class VerdictKind { kAdequate, kNamed, kGroup, kFormIncomplete, kUnknown };
/// "adequate", "named", "group", "form_incomplete", "unknown"
const char* get_name(VerdictKind kind);

struct CauseParameter {
  std::string key, unit;                      // as in a model file: "asymmetry"
  double value = 0.0, low = 0.0, high = 0.0;  // with 95 % interval
};

struct Cause {
  std::string effect, place;
  double probability = 0.0;
  double delta_chi2 = 0.0;  // fall of chi2 with the effect
  std::vector<CauseParameter> parameters;
  EffectChange change = EffectChange::kAdded;
  bool converged = true;  // the fit from which probability and delta chi2 follow
};

bool is_same(const Cause& a, const Cause& b);
bool is_in(const std::vector<Cause>& causes, const Cause& cause);

/// A parameter of the model before and after the extension, with 95 % intervals.
struct ParameterChange {
  std::string name, unit;
  double before = 0.0, before_low = 0.0, before_high = 0.0;
  double after = 0.0, after_low = 0.0, after_high = 0.0;
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
  double log_likelihood_before = 0.0, log_likelihood_after = 0.0;  // per sample
  double log_odds = 0.0;  // of the extended against the calibrated model, over all samples
};

/// Where the residual of the calibrated model is largest.
struct Where {
  std::string channel, time, band, depends_on, place;
};

/// A force of a strut that is not in the catalogue.
struct UnknownForce {
  std::string place;      // as a force map's
  ForceMap map;           // of the extended model
  VisitedStates states;   // of the strut in the runs for fitting
  MapDependence depends;  // of the map over these states
  double fraction = 0.0;  // of the held-out runs' excess over noise that the map removes
};

/// Curves of one run for the report: measured, and the readings of the calibrated and the extended
/// model.
struct DiagnosedRun {
  std::size_t run = 0;
  RunEvaluation before, after;
};

struct Diagnosis {
  VerdictKind kind = VerdictKind::kAdequate;
  std::string sentence;           // the verdict in words
  std::vector<Cause> causes;      // accepted, the largest first
  std::vector<Cause> group;       // all that the data cannot distinguish, causes included; or empty
  std::vector<Cause> runners_up;  // other fitted candidates
  double unknown_share = 0.0;     // probability that the cause is none of the catalogue
  Where where;
  std::optional<UnknownForce> force;  // of the extended model, in addition to the causes
  std::vector<ParameterChange> parameters;
  Improvement improvement;
  std::vector<std::string> not_identifiable;
  std::string next_measurement;
  Selection selection;
  std::vector<DiagnosedRun> runs;
  std::vector<std::string> notes;  // for the user
  /// Whether every held-out run could be simulated, and the calibration converged or is close to
  /// its minimum compared with the delta chi2 of the causes.
  bool is_whole = true;

  /// Whether there is an extended model.
  bool is_extended() const { return !causes.empty() || force.has_value(); }
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
