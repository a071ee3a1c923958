#include "diagnose/decide/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/math/normal.h"
#include "base/names/name_table.h"
#include "base/text/format_number.h"
#include "diagnose/decide/improvement.h"
#include "diagnose/decide/name_causes.h"
#include "diagnose/decide/next_measurement.h"
#include "diagnose/decide/sentence.h"
#include "diagnose/discrepancy/leftover.h"

namespace strut {
namespace {

constexpr std::array<Named<VerdictKind>, 5> kVerdicts = {
    {{VerdictKind::kAdequate, "adequate"},
     {VerdictKind::kNamed, "named"},
     {VerdictKind::kGroup, "group"},
     {VerdictKind::kFormIncomplete, "form_incomplete"},
     {VerdictKind::kUnknown, "unknown"}}};
static_assert(names_all(kVerdicts, VerdictKind::kUnknown));

/// Fits a force map if the remaining residual may be a force in a strut. The extended model then
/// has the map beside the causes or, if it does better without them, instead.
std::optional<UnknownForce> find_force(const CampaignData& data, const DiagnoseOptions& options,
                                       Selection& selection) {
  ForceMapOptions map_options;
  map_options.threads = options.threads;
  map_options.progress = options.progress;
  std::optional<ForceMapFit> found = choose_force_map(data, selection, map_options);
  if (!found) return std::nullopt;
  if (found->replaces_causes) {
    selection.causes.clear();
    selection.round_of.clear();
    selection.gains.clear();
  }
  selection.extended = std::move(found->fit);
  selection.hold_out_after = std::move(found->judged);
  const std::string place = found->states.place;
  const ForceMaps maps = list_force_maps_on(data, selection.extended.shared());
  UnknownForce force{
      place, *find_force_map(maps, place), std::move(found->states), {}, found->share};
  force.depends = measure_dependence(force.map, force.states);
  return force;
}

std::vector<ParameterChange> list_changes(const Selection& selection) {
  std::vector<ParameterChange> changes;
  const WhitenedFit &before = selection.base, &after = selection.extended;
  for (std::size_t i = 0; i < before.shared_count; ++i) {
    const Unknown& u = before.fit.unknowns[i];
    const double spread = kNormal95 * before.fit.widened.sigma[i];
    ParameterChange c{u.name, u.unit, before.fit.values[i], 0.0, 0.0, 0.0, 0.0, 0.0};
    c.before_low = c.before - spread;
    c.before_high = c.before + spread;
    const double after_spread = kNormal95 * after.fit.widened.sigma[i];
    c.after = after.fit.values[i];
    c.after_low = c.after - after_spread;
    c.after_high = c.after + after_spread;
    changes.push_back(std::move(c));
  }
  return changes;
}

/// Time, band and state in which a channel's residual is largest.
void fill_largest(const ChannelComparison& c, Where& where) {
  const auto window = std::max_element(
      c.windows.begin(), c.windows.end(),
      [](const WindowResidual& a, const WindowResidual& b) { return a.rms < b.rms; });
  if (window != c.windows.end()) where.time = window->window.name;
  const auto band = std::max_element(
      c.bands.begin(), c.bands.end(),
      [](const BandResidual& a, const BandResidual& b) { return a.residual_rms < b.residual_rms; });
  if (band != c.bands.end()) where.band = describe(band->band);
  const auto state = std::max_element(
      c.states.begin(), c.states.end(),
      [](const StateResidual& a, const StateResidual& b) { return a.explained < b.explained; });
  if (state != c.states.end()) where.depends_on = state->state;
}

/// Where the calibrated model, without any extension, is worst.
Where find_worst(const CampaignData& data, const Selection& selection) {
  Where where;
  double max_excess = 0.0;
  const SharedValues shared = selection.base.shared();
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    const ModelComparison run = compare_run(data, r, shared, make_time_windows(data, r));
    for (const ChannelComparison& c : run.channels) {
      if (c.chi2_per_reading / c.limit <= max_excess) continue;
      max_excess = c.chi2_per_reading / c.limit;
      where.channel = data.info(c.channel).name;
      fill_largest(c, where);
    }
  }
  return where;
}

/// The place that explains the remaining residual, if one clearly does.
std::string find_place(const Leftover& left) {
  constexpr double kClear = 5.0;
  for (const LeftoverPlace& place : left.places) {
    if (place.energy < kClear * place.sigma) continue;
    return name_strut(place.name);
  }
  return "";
}

Where find_where(const CampaignData& data, const Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  Where where = find_worst(data, selection);
  where.place = selection.is_left ? find_place(selection.left) : "";
  if (diagnosis.force) {
    where.place = name_strut(diagnosis.force->place);
    where.depends_on =
        fmt::format("{} {}", diagnosis.force->states.describe(), diagnosis.force->depends.words);
  }
  if (diagnosis.kind == VerdictKind::kUnknown || diagnosis.kind == VerdictKind::kFormIncomplete) {
    where.band = describe(selection.left.band);
  }
  return where;
}

/// Whether a calibration that has not converged is close to its minimum compared with the causes'
/// delta chi2.
bool is_near(const FitResult& calibration, const Selection& selection) {
  constexpr double kSmall = 0.05;
  const double taken = std::accumulate(selection.gains.begin(), selection.gains.end(), 0.0);
  const double unit = std::max(1.0, calibration.chi2_per_degree());
  return calibration.distance * calibration.distance * unit < kSmall * taken;
}

void check_convergence(const WhitenedFit& fit, const std::string& name, Diagnosis& diagnosis) {
  if (fit.fit.converged) return;
  diagnosis.notes.push_back(fmt::format(
      "the fit of the {} model has not converged: its minimum is {} standard deviations away", name,
      format_rounded(fit.fit.distance)));
}

/// Notes and `is_whole`: fits that have not converged, runs that could not be simulated.
void check_results(Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  check_convergence(selection.base, "calibrated", diagnosis);
  // The held-out runs confirm causes by comparison with the calibrated model, so that must be close
  // to its minimum. Wherever the extended model's fit ended, confirmed causes stand.
  if (!selection.base.fit.converged && !is_near(selection.base.fit, selection)) {
    diagnosis.is_whole = false;
  }
  if (diagnosis.is_extended()) check_convergence(selection.extended, "extended", diagnosis);
  for (const DiagnosedRun& run : diagnosis.runs) {
    for (const RunEvaluation* model : {&run.before, &run.after}) {
      if (model->failure.empty()) continue;
      diagnosis.notes.push_back(model->failure);
      diagnosis.is_whole = false;
    }
  }
}

}  // namespace

const char* get_name(VerdictKind kind) { return find_name(kVerdicts, kind); }

bool is_same(const Cause& a, const Cause& b) { return a.effect == b.effect && a.place == b.place; }

bool is_in(const std::vector<Cause>& causes, const Cause& cause) {
  return std::any_of(causes.begin(), causes.end(),
                     [&](const Cause& other) { return is_same(other, cause); });
}

Diagnosis diagnose_campaign(const CampaignData& data, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  SelectOptions select;
  select.threads = options.threads;
  select.progress = options.progress;
  diagnosis.selection = select_causes(data, select);
  Selection& selection = diagnosis.selection;
  if (selection.is_left) diagnosis.force = find_force(data, options, selection);
  name_causes(data, diagnosis);
  diagnosis.parameters = list_changes(selection);
  const FitResult& extended = selection.extended.fit;
  diagnosis.not_identifiable = describe_null_directions(extended.widened, extended.unknowns);
  if (options.progress) options.progress("measuring the improvement");
  diagnosis.runs = evaluate_hold_out(data, selection, options.threads);
  check_results(diagnosis);
  diagnosis.improvement = calc_improvement(data, selection, diagnosis.runs);
  diagnosis.where = find_where(data, diagnosis);
  diagnosis.next_measurement = propose_measurement(data, selection, diagnosis.group);
  diagnosis.sentence = write_sentence(diagnosis);
  return diagnosis;
}

}  // namespace strut
