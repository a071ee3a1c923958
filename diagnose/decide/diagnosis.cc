#include "diagnose/decide/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math/normal.h"
#include "base/text/format_number.h"
#include "diagnose/decide/gain.h"
#include "diagnose/decide/next_measurement.h"
#include "diagnose/decide/probability.h"
#include "diagnose/discrepancy/leftover.h"

namespace strut {
namespace {

std::string join(const std::vector<std::string>& names, const std::string& between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

std::string describe(const Cause& cause) { return describe_effect(cause.effect, cause.place); }

CauseParameter make_parameter_of(const CampaignData& data, const Hypothesis& h, std::size_t i,
                                 double value, double sigma) {
  const auto parameters = list_effect_parameters(*find_effect(h.effect), data.model());
  const EffectParameter& p = *parameters[i];
  CauseParameter c{p.name, p.unit, value, value - kNormal95 * sigma, value + kNormal95 * sigma};
  c.low = std::clamp(c.low, p.low, std::max(p.low, value));
  c.high = std::clamp(c.high, std::min(p.high, value), p.high);
  return c;
}

Cause make_cause(const CampaignData& data, const Candidate& candidate, double probability) {
  Cause cause{
      candidate.hypothesis.effect, candidate.hypothesis.place, probability, candidate.gain, {}};
  for (std::size_t i = 0; i < candidate.values.size(); ++i) {
    cause.parameters.push_back(
        make_parameter_of(data, candidate.hypothesis, i, candidate.values[i], candidate.sigma[i]));
  }
  return cause;
}

/// Values and intervals of a cause's parameters as the extended model's fit has them.
void set_fitted(const CampaignData& data, const WhitenedFit& fit, const Hypothesis& h,
                Cause& cause) {
  cause.parameters.clear();
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    for (std::size_t k = 0; k < fit.shared_count; ++k) {
      if (fit.fit.unknowns[k].name != h.parameters[i].name) continue;
      cause.parameters.push_back(
          make_parameter_of(data, h, i, fit.fit.values[k], fit.fit.widened.sigma[k]));
    }
  }
}

/// Probabilities of what one round fitted, with that of a cause outside of the catalogue.
void fill_probabilities(const CampaignData& data, const SelectRound& round,
                        const Hypothesis& chosen, double unknown, Diagnosis& diagnosis) {
  const ProbabilityOptions options;
  const std::vector<double> odds = calc_log_odds(round, options);
  double sum = 0.0, own = 0.0;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    if (round.candidates[i].gain <= 0.0) continue;
    sum += std::exp(odds[i]);
    const Hypothesis& h = round.candidates[i].hypothesis;
    if (h.effect == chosen.effect && h.place == chosen.place) own = odds[i];
  }
  std::vector<Cause> close;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    const Candidate& c = round.candidates[i];
    if (c.gain <= 0.0) continue;
    Cause cause = make_cause(data, c, (1.0 - unknown) * std::exp(odds[i]) / sum);
    const bool is_chosen =
        c.hypothesis.effect == chosen.effect && c.hypothesis.place == chosen.place;
    if (odds[i] > own - options.group_odds) {
      close.push_back(cause);
    } else if (!is_chosen) {
      diagnosis.runners_up.push_back(cause);
    }
    if (is_chosen) diagnosis.causes.push_back(std::move(cause));
  }
  std::stable_sort(close.begin(), close.end(),
                   [](const Cause& a, const Cause& b) { return a.probability > b.probability; });
  if (close.size() > 1) {
    diagnosis.group.insert(diagnosis.group.end(), close.begin(), close.end());
  }
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

/// Where the calibrated model, without any extension, goes wrong most: channel, time, band, state.
Where find_where(const CampaignData& data, const Selection& selection) {
  Where where;
  double most = 0.0;
  const SharedValues shared = selection.base.shared();
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    const ModelComparison run = compare_run(data, r, shared, make_time_windows(data, r));
    for (const ChannelComparison& c : run.channels) {
      if (c.chi2_per_reading / c.limit <= most) continue;
      most = c.chi2_per_reading / c.limit;
      where.channel = data.info(c.channel).name;
      const auto window = std::max_element(
          c.windows.begin(), c.windows.end(),
          [](const WindowResidual& a, const WindowResidual& b) { return a.rms < b.rms; });
      if (window != c.windows.end()) where.time = window->window.name;
      const auto band = std::max_element(c.bands.begin(), c.bands.end(),
                                         [](const BandResidual& a, const BandResidual& b) {
                                           return a.residual_rms < b.residual_rms;
                                         });
      if (band != c.bands.end()) where.band = strut::describe(band->band);
      const auto state = std::max_element(
          c.states.begin(), c.states.end(),
          [](const StateResidual& a, const StateResidual& b) { return a.explained < b.explained; });
      if (state != c.states.end()) where.depends_on = state->state;
    }
  }
  return where;
}

/// A rig's only strut has no name in its file, but in a sentence.
std::string name_strut(const std::string& place) { return place.empty() ? "strut" : place; }

/// The place that holds what is left, as far as one is better than noise.
std::string find_place(const Leftover& left) {
  constexpr double kClear = 5.0;
  for (const LeftoverPlace& place : left.places) {
    if (place.energy < kClear * place.sigma) continue;
    return name_strut(place.name);
  }
  return "";
}

class Diagnoser {
 public:
  Diagnoser(const CampaignData& data, const DiagnoseOptions& options)
      : data_(data), options_(options) {}

  Diagnosis run() {
    SelectOptions select;
    select.threads = options_.threads;
    select.progress = options_.progress;
    diagnosis_.selection = select_causes(data_, select);
    const Selection& selection = diagnosis_.selection;
    left_ = selection.left;
    if (selection.is_left) find_force();
    judge();
    diagnosis_.parameters = list_changes(selection);
    for (const NullDirection& direction : selection.extended.fit.widened.null_directions) {
      diagnosis_.not_identifiable.push_back(
          describe_direction(direction, selection.extended.fit.unknowns));
    }
    tell("measuring the gain");
    diagnosis_.runs = evaluate_hold_out(data_, selection, options_.threads);
    take_notes();
    diagnosis_.gain = calc_hold_out_gain(data_, selection, diagnosis_.runs);
    diagnosis_.where = find_where(data_, selection);
    diagnosis_.where.place = left_place_;
    if (diagnosis_.force) {
      diagnosis_.where.place = name_strut(diagnosis_.force->place);
      diagnosis_.where.depends_on =
          diagnosis_.force->states.describe() + " " + diagnosis_.force->depends.words;
    }
    if (diagnosis_.kind == VerdictKind::kUnknown ||
        diagnosis_.kind == VerdictKind::kFormIncomplete) {
      diagnosis_.where.band = strut::describe(left_.band);
    }
    diagnosis_.next_measurement = propose_measurement(data_, selection, diagnosis_.group);
    diagnosis_.sentence = write_sentence();
    return std::move(diagnosis_);
  }

 private:
  void tell(const std::string& what) const {
    if (options_.progress) options_.progress(what);
  }

  /// Whether chi2 at the minimum that a calibration has not reached is below its own by a small
  /// part only of what the causes take of it.
  bool is_near(const FitResult& calibration) const {
    constexpr double kSmall = 0.05;
    const std::vector<double>& gains = diagnosis_.selection.gains;
    const double gained = std::accumulate(gains.begin(), gains.end(), 0.0);
    const double unit = std::max(1.0, calibration.chi2_per_degree());
    return calibration.distance * calibration.distance * unit < kSmall * gained;
  }

  /// What a user must know before anything else is believed.
  void take_notes() {
    for (const bool extended : {false, true}) {
      if (extended && !diagnosis_.is_extended()) continue;
      const WhitenedFit& fit = extended ? diagnosis_.selection.extended : diagnosis_.selection.base;
      if (fit.fit.converged) continue;
      diagnosis_.notes.push_back(std::string("the fit of the ") +
                                 (extended ? "extended" : "calibrated") +
                                 " model has not converged: its minimum is " +
                                 format_rounded(fit.fit.distance) + " standard deviations away");
      // What the runs held out confirm stands wherever its fit ended. They compare it with the
      // calibrated model, so that must lack little of its minimum beside what the causes gain.
      if (!extended) diagnosis_.is_whole = diagnosis_.is_whole && is_near(fit.fit);
    }
    for (const DiagnosedRun& run : diagnosis_.runs) {
      for (const RunEvaluation* model : {&run.before, &run.after}) {
        if (model->failure.empty()) continue;
        diagnosis_.notes.push_back(model->failure);
        diagnosis_.is_whole = false;
      }
    }
  }

  /// What is left may be a force in a strut: then the extended model has its map, beside the causes
  /// or, where it does better without them, instead.
  void find_force() {
    Selection& selection = diagnosis_.selection;
    ForceMapOptions options;
    options.threads = options_.threads;
    options.progress = options_.progress;
    std::optional<ForceMapFit> found = choose_force_map(data_, selection, options);
    if (!found) return;
    if (found->replaces_causes) {
      selection.causes.clear();
      selection.round_of.clear();
      selection.gains.clear();
    }
    selection.extended = std::move(found->fit);
    selection.hold_out_after = std::move(found->judged);
    const std::string place = found->states.place;
    const ForceMaps maps = list_force_maps_on(data_, selection.extended.shared());
    UnknownForce force{
        place, *find_force_map(maps, place), std::move(found->states), {}, found->share};
    force.depends = measure_dependence(force.map, force.states);
    diagnosis_.force = std::move(force);
  }

  void judge() {
    const Selection& selection = diagnosis_.selection;
    const bool is_left = selection.is_left;
    left_place_ = is_left ? find_place(left_) : "";
    double gain = 0.0;
    for (std::size_t i = 0; i < selection.causes.size(); ++i) gain += selection.gains[i];
    const double share = gain + left_.energy > 0.0 ? left_.energy / (gain + left_.energy) : 0.0;
    // A cause of another form leaves some share of itself; what leaves more is another cause.
    constexpr double kSure = 0.02, kMiddle = 0.5, kWidth = 0.08;
    double unknown = kSure;
    if (is_left) unknown = std::max(kSure, 1.0 / (1.0 + std::exp((kMiddle - share) / kWidth)));
    if (selection.causes.empty()) {
      diagnosis_.kind = is_left ? VerdictKind::kUnknown : VerdictKind::kAdequate;
      diagnosis_.unknown_share = is_left ? 1.0 : 0.0;
      for (const Candidate& c : selection.rounds.front().candidates) {
        if (is_left && c.gain > 0.0) {
          diagnosis_.runners_up.push_back(make_cause(data_, c, 0.0));
        }
      }
      return;
    }
    diagnosis_.unknown_share = unknown;
    for (std::size_t i = 0; i < selection.causes.size(); ++i) {
      fill_probabilities(data_, selection.rounds[selection.round_of[i]], selection.causes[i],
                         unknown, diagnosis_);
    }
    drop_repeated();
    for (std::size_t i = 0; i < diagnosis_.causes.size(); ++i) {
      for (const Hypothesis& h : selection.causes) {
        if (h.effect == diagnosis_.causes[i].effect && h.place == diagnosis_.causes[i].place) {
          set_fitted(data_, selection.extended, h, diagnosis_.causes[i]);
        }
      }
    }
    if (is_left) {
      // A map beside the causes that takes most of what is left leaves them their names.
      const bool is_named = diagnosis_.force && diagnosis_.force->share > 0.5;
      diagnosis_.kind =
          unknown > 0.5 && !is_named ? VerdictKind::kUnknown : VerdictKind::kFormIncomplete;
    } else {
      diagnosis_.kind = diagnosis_.group.empty() ? VerdictKind::kNamed : VerdictKind::kGroup;
    }
  }

  /// A runner-up of one round may be the cause of another, or run in several.
  void drop_repeated() {
    std::vector<Cause> kept;
    const auto is_in = [](const std::vector<Cause>& list, const Cause& c) {
      return std::any_of(list.begin(), list.end(), [&](const Cause& other) {
        return other.effect == c.effect && other.place == c.place;
      });
    };
    for (Cause& c : diagnosis_.runners_up) {
      if (is_in(diagnosis_.causes, c) || is_in(diagnosis_.group, c) || is_in(kept, c)) continue;
      kept.push_back(std::move(c));
    }
    diagnosis_.runners_up = std::move(kept);
  }

  std::string write_sentence() const {
    std::vector<std::string> names;
    for (const Cause& cause : diagnosis_.causes) names.push_back(describe(cause));
    const std::string what = join(names, " and ");
    const std::string gain = describe_gain();
    switch (diagnosis_.kind) {
      case VerdictKind::kAdequate:
        return "The calibrated model is adequate: no effect of the catalogue, and nothing else, "
               "stands out of the noise.";
      case VerdictKind::kNamed:
        return "The model lacks " + what + "; with it, " + gain + ".";
      case VerdictKind::kGroup: {
        std::vector<std::string> group;
        for (const Cause& cause : diagnosis_.group) group.push_back(describe(cause));
        return "The model lacks one that these runs cannot tell apart of: " + join(group, ", ") +
               "; with " + what + ", " + gain + ".";
      }
      case VerdictKind::kFormIncomplete:
        return "The model lacks " + what + ", but that is not all: more is left than noise" +
               describe_left() + "; " + (diagnosis_.force ? describe_share() : "so far " + gain) +
               ".";
      case VerdictKind::kUnknown:
        break;
    }
    std::string sentence =
        "The model lacks something that the catalogue does not have" + describe_left();
    if (!what.empty()) sentence += "; nearest: " + what;
    if (diagnosis_.force) return sentence + "; " + describe_share() + ".";
    return sentence + (what.empty() ? "." : ", " + gain + ".");
  }

  std::string describe_gain() const {
    const std::optional<double>& explained = diagnosis_.gain.explained;
    // Many readings together tell what no channel shows alone.
    if (!explained) {
      return "the runs held out are exp(" + format_rounded(std::round(diagnosis_.gain.log_odds)) +
             ") times as likely";
    }
    return format_rounded(std::round(100.0 * *explained)) +
           " % of what could be gained on the runs held out";
  }

  std::string describe_share() const {
    return "its map takes " + format_rounded(std::round(100.0 * diagnosis_.force->share)) +
           " % of what the runs held out still had beyond noise";
  }

  std::string describe_left() const {
    if (diagnosis_.force) {
      const UnknownForce& force = *diagnosis_.force;
      return ": a force in the " + (force.place.empty() ? "" : force.place + " ") +
             (force.place.empty() ? "strut" : "struts") + " that depends on " + force.depends.words;
    }
    std::string text;
    if (!left_place_.empty()) text += ", acting at " + left_place_;
    text += ", at " + strut::describe(left_.band);
    return text;
  }

  const CampaignData& data_;
  const DiagnoseOptions& options_;
  Diagnosis diagnosis_;
  Leftover left_;
  std::string left_place_;
};

}  // namespace

const char* get_name(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::kAdequate:
      return "adequate";
    case VerdictKind::kNamed:
      return "named";
    case VerdictKind::kGroup:
      return "group";
    case VerdictKind::kFormIncomplete:
      return "form_incomplete";
    case VerdictKind::kUnknown:
      break;
  }
  return "unknown";
}

Diagnosis diagnose_campaign(const CampaignData& data, const DiagnoseOptions& options) {
  return Diagnoser(data, options).run();
}

}  // namespace strut
