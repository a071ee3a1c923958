// The whole diagnosis of a campaign: what the simulation gets wrong, which effect of the catalogue
// says so, how sure that is, what the extended model gains on runs it was not fitted to, and
// what to measure next.
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
  double value = 0.0, low = 0.0, high = 0.0;  // and 95 % interval
};

struct Cause {
  std::string effect, place;
  double probability = 0.0;
  double gain = 0.0;  // by which it makes chi2 fall
  std::vector<CauseParameter> parameters;
};

/// A parameter of the model before and after the extension, with 95 % intervals.
struct ParameterChange {
  std::string name, unit;
  double before = 0.0, before_low = 0.0, before_high = 0.0;
  double after = 0.0, after_low = 0.0, after_high = 0.0;
};

/// One channel over all runs held out.
struct ChannelGain {
  std::string channel, unit;
  double rms_before = 0.0, rms_after = 0.0, noise_floor = 0.0;
  double nrmse_before = 0.0, nrmse_after = 0.0;  // over the measured spread
};

struct HoldOutGain {
  std::vector<ChannelGain> channels;
  /// (before - after) / (before - floor) of the rms, the floor with its tolerance, summed over
  /// channels in units of their floors. Nothing where no channel stands above its floor before.
  std::optional<double> explained;
  double log_likelihood_before = 0.0, log_likelihood_after = 0.0;  // per sample
  double log_odds = 0.0;  // of the extended model against the calibrated one, all samples
};

/// Where the residual of the calibrated model is seen best.
struct Where {
  std::string channel, time, band, depends_on, place;
};

/// A force of a strut that the catalogue does not have.
struct UnknownForce {
  std::string place;      // as a force map's
  ForceMap map;           // as the extended model has it
  VisitedStates states;   // where the strut was in the runs for fitting
  MapDependence depends;  // of the map on these
  double share = 0.0;     // of what the runs held out have beyond noise that the map takes
};

/// Curves of one run for the report: measured, and the readings of the calibrated and the extended
/// model.
struct DiagnosedRun {
  std::size_t run = 0;
  RunEvaluation before, after;
};

struct Diagnosis {
  VerdictKind kind = VerdictKind::kAdequate;
  std::string sentence;           // the verdict in one
  std::vector<Cause> causes;      // accepted, the largest first
  std::vector<Cause> group;       // all that the data cannot tell apart, causes among them; or none
  std::vector<Cause> runners_up;  // the rest that was fitted
  double unknown_share = 0.0;     // probability that the cause is none of the catalogue
  Where where;
  std::optional<UnknownForce> force;  // what the extended model has beside the causes
  std::vector<ParameterChange> parameters;
  HoldOutGain gain;
  std::vector<std::string> not_identifiable;
  std::string next_measurement;
  Selection selection;
  std::vector<DiagnosedRun> runs;
  std::vector<std::string> notes;  // for the user
  /// Every run held out could be simulated, and the calibration converged, or lacks little of its
  /// minimum beside what confirmed causes gain.
  bool is_whole = true;

  /// Whether there is an extended model.
  bool is_extended() const { return !causes.empty() || force.has_value(); }
};

struct DiagnoseOptions {
  int threads = 1;
  std::function<void(const std::string&)> progress;  // what is being done
};

Diagnosis diagnose_campaign(const CampaignData& data, const DiagnoseOptions& options = {});

/// The model's file with the causes switched on at their fitted values, the force map, and the
/// parameters that the diagnosis fitted; it can stand wherever a model file is named. `folder`:
/// where it will lie; the files that the model names are named from there.
std::string make_extended_model(const CampaignData& data, const Diagnosis& diagnosis,
                                const std::filesystem::path& folder);

}  // namespace strut
