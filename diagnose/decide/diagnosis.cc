#include "diagnose/decide/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/error/check.h"
#include "base/text/format_number.h"
#include "diagnose/compare/deciding_noise.h"
#include "diagnose/decide/acceptance.h"
#include "diagnose/decide/effect_round.h"
#include "diagnose/decide/improvement.h"
#include "diagnose/decide/next_measurement.h"
#include "diagnose/decide/parameter_changes.h"
#include "diagnose/decide/sentence.h"
#include "diagnose/discrepancy/leftover.h"

namespace strut {
namespace {

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
    selection.refusal = Refusal::kNone;
  }
  selection.extended = std::move(found->fit);
  selection.hold_out_after = std::move(found->judged);
  TestBench bench(data, selection.extended, options.threads);
  selection.undetected = find_undetected(data, selection.extended, bench);
  const std::string place = found->states.place;
  const ForceMaps maps = list_force_maps_on(data, selection.extended.shared());
  UnknownForce force{
      place, *find_force_map(maps, place), std::move(found->states), {}, found->share};
  force.depends = measure_dependence(force.map, force.states);
  return force;
}

/// Time, band and state in which a channel's residual is largest.
void fill_largest(const ChannelComparison& c, Where& where) {
  const auto window = std::max_element(
      c.windows.begin(), c.windows.end(),
      [](const WindowResidual& a, const WindowResidual& b) { return a.rms < b.rms; });
  if (window != c.windows.end()) {
    const TimeWindow& w = window->window;
    const double width = w.to - w.from;
    where.time = fmt::format("{}, {} to {} s of the run", w.name, format_to_error(w.from, width),
                             format_to_error(w.to, width));
  }
  const auto band = std::max_element(
      c.bands.begin(), c.bands.end(),
      [](const BandResidual& a, const BandResidual& b) { return a.residual_rms < b.residual_rms; });
  if (band != c.bands.end()) where.band = describe(band->band);
  const auto state = std::max_element(
      c.states.begin(), c.states.end(),
      [](const StateResidual& a, const StateResidual& b) { return a.explained < b.explained; });
  if (state != c.states.end()) where.depends_on = state->state;
}

/// Where the calibrated model, without any extension, is worst in the runs for fitting.
Where find_largest(const CampaignData& data, const std::vector<DiagnosedRun>& runs) {
  Where where;
  double max_excess = 0.0;
  for (const DiagnosedRun& run : runs) {
    if (data.campaign.runs[run.run].use != RunUse::kFit) continue;
    for (const ChannelComparison& c : run.before.channels) {
      if (c.chi2_per_reading / c.limit <= max_excess) continue;
      max_excess = c.chi2_per_reading / c.limit;
      where.run = data.campaign.runs[run.run].name;
      where.channel = data.info(c.channel).name;
      fill_largest(c, where);
    }
  }
  return where;
}

Where find_where(const CampaignData& data, const Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  Where where = find_largest(data, diagnosis.runs);
  const LeftoverPlace* clear = selection.is_left ? find_clear_place(selection.left) : nullptr;
  where.place = clear == nullptr ? "" : name_strut(clear->name);
  if (diagnosis.force) {
    where.place = name_strut(diagnosis.force->place);
    where.depends_on =
        fmt::format("{} {}", diagnosis.force->states.describe(), diagnosis.force->depends.words);
  }
  const VerdictKind kind = diagnosis.verdict.kind;
  const bool remains = kind == VerdictKind::kUnknown || kind == VerdictKind::kFormIncomplete;
  if (remains && is_significant(selection.left)) where.band = describe(selection.left.band);
  return where;
}

void check_convergence(const WhitenedFit& fit, const std::string& name, Diagnosis& diagnosis) {
  if (fit.fit.converged) return;
  diagnosis.notes.push_back(fmt::format(
      "the fit of the {} model has not converged: its minimum is {} standard deviations away", name,
      format_significant(fit.fit.distance, 2)));
}

/// Notes and `is_whole`: fits that have not converged, runs that could not be simulated.
void check_results(Diagnosis& diagnosis) {
  const Selection& selection = diagnosis.selection;
  check_convergence(selection.base, "calibrated", diagnosis);
  // The held-out runs confirm causes by comparison with the calibrated model, so that must be close
  // to its minimum. Wherever the extended model's fit ended, confirmed causes stand.
  if (!selection.base.fit.converged && !is_near_minimum(selection.base.fit, selection.gains)) {
    diagnosis.is_whole = false;
  }
  if (diagnosis.is_extended()) check_convergence(selection.extended, "extended", diagnosis);
  for (const DiagnosedRun& run : diagnosis.runs) {
    for (const ModelComparison* model : {&run.before, &run.after}) {
      if (model->evaluation.failure.empty()) continue;
      diagnosis.notes.push_back(model->evaluation.failure);
      diagnosis.is_whole = false;
    }
  }
}

/// Notes on channels whose agreement with the last model rests on an estimated noise.
void add_noise_notes(const CampaignData& data, Diagnosis& diagnosis) {
  std::vector<const ModelComparison*> models;
  for (const DiagnosedRun& run : diagnosis.runs) {
    models.push_back(diagnosis.is_extended() ? &run.after : &run.before);
  }
  for (std::string& note : describe_deciding_noise(data, models)) {
    diagnosis.notes.push_back(std::move(note));
  }
}

/// Withdraws the causes and the map: the extended model is the calibrated one, and what they
/// explained is residual.
void withdraw(const CampaignData& data, const DiagnoseOptions& options, Diagnosis& diagnosis) {
  Selection& s = diagnosis.selection;
  const double gain = std::accumulate(s.gains.begin(), s.gains.end(), 0.0);
  s.causes.clear();
  s.round_of.clear();
  s.gains.clear();
  s.extended = s.base;
  s.hold_out_after = s.hold_out_before;
  s.undetected = s.rounds.front().undetected;
  s.refusal = Refusal::kNone;
  diagnosis.force.reset();
  TestBench bench(data, s.base, options.threads);
  s.left = measure_leftover(data, bench);
  s.left.energy = std::max(s.left.energy, gain);
  s.is_left = true;
}

/// Fits the force map, claims what is more probable than a cause outside of the catalogue, and
/// withdraws the rest from the extended model.
void claim(const CampaignData& data, const DiagnoseOptions& options, Diagnosis& diagnosis) {
  Selection& selection = diagnosis.selection;
  if (selection.is_left) diagnosis.force = find_force(data, options, selection);
  diagnosis.verdict =
      make_claim(data.model(), selection, diagnosis.force ? diagnosis.force->fraction : 0.0);
  if (selection.causes.empty() || !diagnosis.verdict.positions.empty()) return;
  withdraw(data, options, diagnosis);
  diagnosis.force = find_force(data, options, selection);
}

/// Withdraws an extension that makes the held-out runs worse.
void check_improvement(const CampaignData& data, const DiagnoseOptions& options,
                       Diagnosis& diagnosis) {
  if (!diagnosis.is_extended() || is_improved(diagnosis.improvement)) return;
  const std::string extension = describe_extension(diagnosis);
  diagnosis.notes.push_back(
      fmt::format("withdrawn, since the held-out runs became worse: {}", extension));
  diagnosis.verdict.reject(1.0);
  withdraw(data, options, diagnosis);
  diagnosis.selection.refusal = Refusal::kContradicted;
  diagnosis.selection.refused = extension;
  for (DiagnosedRun& run : diagnosis.runs) run.after = run.before;
  diagnosis.improvement = calc_improvement(data, diagnosis.selection, diagnosis.runs);
}

void judge_models(const CampaignData& data, Diagnosis& diagnosis) {
  Verdict& verdict = diagnosis.verdict;
  // Those of the effects' own parameters are not stated.
  const SharedValues base = diagnosis.selection.base.shared();
  SharedValues after = diagnosis.selection.extended.shared();
  after.unknowns.resize(base.unknowns.size());
  diagnosis.conflicts = list_prior_conflicts(after.unknowns, after.values, 0);
  for (const DiagnosedRun& run : diagnosis.runs) {
    add_misfits(data, run.run, run.before, diagnosis.misfits_before);
    add_misfits(data, run.run, run.after, verdict.misfits);
    diagnosis.conflicts.insert(diagnosis.conflicts.end(), run.after.conflicts.begin(),
                               run.after.conflicts.end());
  }
  verdict.conclude(diagnosis.selection.is_left, diagnosis.force.has_value());
}

/// Checks that the effects of the extended model beyond the file's are those of the verdict.
void check_extension(const Diagnosis& diagnosis) {
  const Selection& s = diagnosis.selection;
  const std::vector<Cause> causes = diagnosis.verdict.list_causes();
  STRUT_CHECK(causes.size() == s.causes.size(), "the extended model has causes without a claim");
  for (const Hypothesis& h : s.causes) {
    STRUT_CHECK(is_in(causes, Cause{h.effect, h.place, 0.0, 0.0, {}, h.change}),
                h.describe() + " is not claimed");
    for (const HypothesisParameter& p : h.parameters) {
      STRUT_CHECK(is_among(s.extended.fit.unknowns, p.name), p.name + " was not fitted");
    }
  }
}

/// Names of the held-out runs that contradict the model, each once.
std::string list_contradicting(const CampaignData& data, const std::vector<Misfit>& misfits) {
  std::string names;
  std::size_t last = data.run_count();
  for (const Misfit& m : misfits) {
    if (m.run != last) names += (names.empty() ? "" : ", ") + data.campaign.runs[m.run].name;
    last = m.run;
  }
  return names;
}

std::string propose_next(const CampaignData& data, const Diagnosis& diagnosis) {
  const Verdict& verdict = diagnosis.verdict;
  if (!verdict.misfits.empty() && !diagnosis.selection.is_left &&
      are_held_out(data, verdict.misfits)) {
    return fmt::format("none is needed yet: use {} for fitting, too, where the cause shows",
                       list_contradicting(data, verdict.misfits));
  }
  for (const CausePosition& p : verdict.positions) {
    if (p.close > 1) return propose_measurement(data, diagnosis.selection, p.list_close());
  }
  return propose_measurement(data, diagnosis.selection, {});
}

}  // namespace

Diagnosis diagnose_campaign(const CampaignData& data, const DiagnoseOptions& options) {
  Diagnosis diagnosis;
  SelectOptions select;
  select.threads = options.threads;
  select.progress = options.progress;
  diagnosis.selection = select_causes(data, select);
  claim(data, options, diagnosis);
  if (options.progress) options.progress("measuring the improvement");
  diagnosis.runs = evaluate_runs(data, diagnosis, options.threads);
  diagnosis.improvement = calc_improvement(data, diagnosis.selection, diagnosis.runs);
  check_improvement(data, options, diagnosis);
  judge_models(data, diagnosis);
  check_verdict(diagnosis.verdict, diagnosis.force.has_value());
  check_extension(diagnosis);
  check_results(diagnosis);
  add_noise_notes(data, diagnosis);
  const Selection& selection = diagnosis.selection;
  diagnosis.parameters = list_parameter_changes(data, diagnosis);
  if (diagnosis.is_extended()) {
    diagnosis.secants = list_secants(data, selection, diagnosis.verdict.positions);
  }
  const FitResult& extended = selection.extended.fit;
  diagnosis.not_identifiable = describe_null_directions(extended.widened, extended.unknowns);
  diagnosis.where = find_where(data, diagnosis);
  diagnosis.next_measurement = propose_next(data, diagnosis);
  diagnosis.sentence = write_sentence(data, diagnosis);
  return diagnosis;
}

}  // namespace strut
