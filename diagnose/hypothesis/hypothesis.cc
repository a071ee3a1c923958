#include "diagnose/hypothesis/hypothesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/math/spread.h"
#include "base/names/corners.h"
#include "base/names/name_table.h"
#include "diagnose/baseline/model_states.h"
#include "model/effects/names.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

constexpr std::array<Named<EffectChange>, 3> kChanges = {{{EffectChange::kAdded, "added"},
                                                          {EffectChange::kChanged, "changed"},
                                                          {EffectChange::kRemoved, "removed"}}};
static_assert(names_all(kChanges, EffectChange::kRemoved));

std::string find_axle(const std::string& place) {
  const auto found = std::find_if(kAxleNames.begin(), kAxleNames.end(),
                                  [&](const char* axle) { return place.starts_with(axle); });
  return found != kAxleNames.end() ? *found : "";
}

double get_shared_parameter(const CampaignData& data, const SharedValues& shared,
                            const std::string& name) {
  for (std::size_t i = 0; i < shared.unknowns.size(); ++i) {
    if (shared.unknowns[i].name == name) return shared.values[i];
  }
  return get_parameter(data.runs[0].setup, name);
}

/// The motion of the struts in the runs for fitting, by StateInfo::place.
std::map<std::string, StrutMotion> measure_motion(const CampaignData& data,
                                                  const SharedValues& shared) {
  std::map<std::string, StrutMotion> motions;
  double runs = 0.0;
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    const RunCurves curves = simulate_motion(data.runs[r], shared.unknowns, shared.values);
    if (!curves.failure.empty()) continue;
    ++runs;
    for (const StateCurve& state : list_states(data, curves)) {
      StrutMotion& m = motions[state.info->place];
      const double spread = calc_spread(state.values);
      switch (state.info->kind) {
        case StateKind::kDeflection:
          m.deflection += spread * spread;
          for (const double v : state.values) {
            if (std::isfinite(v)) m.compression = std::max(m.compression, v);
          }
          break;
        case StateKind::kVelocity:
          m.velocity += spread * spread;
          for (const double v : state.values) {
            if (std::isfinite(v)) m.fastest = std::max(m.fastest, std::abs(v));
          }
          break;
        case StateKind::kTireLoad:
          m.tire_deflection += spread * spread;
          break;
        case StateKind::kGuideVelocity:
          break;
      }
    }
  }
  for (auto& [axle, m] : motions) {
    const std::string head = axle.empty() ? "" : axle + "_";
    m.deflection = std::sqrt(m.deflection / std::max(runs, 1.0));
    m.velocity = std::sqrt(m.velocity / std::max(runs, 1.0));
    m.stiffness = get_shared_parameter(data, shared, head + "stiffness");
    m.damping = get_shared_parameter(data, shared, head + "damping");
    m.tire_deflection = std::sqrt(m.tire_deflection / std::max(runs, 1.0));
    if (data.model().has(kHasTire)) {
      m.tire_deflection /= get_shared_parameter(data, shared, "tire_stiffness");
    }
  }
  return motions;
}

/// Whether the parameter is the model's own, not an effect's, such as a quarter car's tire
/// stiffness.
bool is_own_parameter(const CampaignData& data, const std::string& name) {
  const auto parameters = list_parameters(data.model());
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const Parameter* p) { return p->name == name && !p->is_effect; });
}

/// Whether one of two places is the other, or the axle of the other.
bool overlaps(const std::string& place, const std::string& other) {
  return place.starts_with(other) || other.starts_with(place);
}

enum class OnAt { kNowhere, kPlace, kOverlapping };

/// Where an effect is on, compared with `place`.
OnAt find_on(const EffectSettings& effects, const std::string& effect, const std::string& place) {
  OnAt on = OnAt::kNowhere;
  for (const EffectSetting& s : effects) {
    if (s.effect != effect || !overlaps(s.place, place)) continue;
    if (s.place == place) return OnAt::kPlace;
    on = OnAt::kOverlapping;
  }
  return on;
}

/// Makes it a hypothesis about an effect of the model file: it starts at a fifth less of it.
void change_from_file(const CampaignData& data,
                      const std::vector<const EffectParameter*>& parameters, Hypothesis& h) {
  constexpr double kStartFraction = 0.8;
  h.change = EffectChange::kChanged;
  h.beginnings.emplace_back();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const EffectParameter& p = *parameters[i];
    h.reference[i] = get_parameter(data.runs[0].setup, h.parameters[i].name);
    h.beginnings[0].push_back(p.switches ? p.neutral + kStartFraction * (h.reference[i] - p.neutral)
                                         : h.reference[i]);
  }
}

bool is_compared(const CampaignData& data, const std::string& channel) {
  for (const std::size_t r : data.list_runs(RunUse::kFit)) {
    for (const MeasuredChannel& c : data.channels(r)) {
      if (data.info(c.channel).name == channel) return true;
    }
  }
  return false;
}

bool has_run_with_several_channels(const CampaignData& data) {
  const std::vector<std::size_t> runs = data.list_runs(RunUse::kFit);
  return std::any_of(runs.begin(), runs.end(),
                     [&](std::size_t r) { return data.channels(r).size() > 1; });
}

std::vector<std::vector<double>> make_beginnings(
    const std::vector<const EffectParameter*>& parameters, const SearchStarts& chosen) {
  std::vector<std::vector<double>> beginnings;
  for (const auto& values : chosen) {
    beginnings.emplace_back();
    for (const EffectParameter* p : parameters) {
      const auto found = values.find(p->name);
      double value = p->calc_start();
      if (found != values.end()) value = found->second;
      beginnings.back().push_back(std::clamp(value, p->low, p->high));
    }
  }
  return beginnings;
}

}  // namespace

const char* get_name(EffectChange change) { return find_name(kChanges, change); }

std::string describe_effect(const std::string& effect, const std::string& place,
                            EffectChange change) {
  const std::string head = change == EffectChange::kRemoved   ? "without "
                           : change == EffectChange::kChanged ? "another "
                                                              : "";
  return head + effect + (place.empty() ? "" : " at " + place);
}

std::string Hypothesis::describe() const { return describe_effect(effect, place, change); }

bool is_same_effect(const Hypothesis& a, const Hypothesis& b) {
  return a.effect == b.effect && a.place == b.place;
}

bool are_identical(const Hypothesis& a, const Hypothesis& b, const EffectSettings& on) {
  const bool has_friction = std::any_of(on.begin(), on.end(), [](const EffectSetting& setting) {
    return setting.effect == EffectName::kStrutFriction;
  });
  if (has_friction) return false;
  const auto is_stroke = [](const Hypothesis& h) {
    return h.effect == EffectName::kDamperLeak || h.effect == EffectName::kJointPlay;
  };
  return is_stroke(a) && is_stroke(b) && a.place == b.place && a.beginnings == b.beginnings &&
         a.reference == b.reference;
}

Hypothesis make_removal(const CampaignData& data, const Hypothesis& changed) {
  const auto parameters = list_effect_parameters(*find_effect(changed.effect), data.model());
  Hypothesis h{changed.effect, changed.place, {}, {{}}, EffectChange::kRemoved, {}};
  for (std::size_t i = 0; i < changed.parameters.size(); ++i) {
    if (!changed.parameters[i].switches) continue;
    h.parameters.push_back(changed.parameters[i]);
    h.reference.push_back(changed.reference[i]);
    h.beginnings.front().push_back(parameters[i]->neutral);
  }
  return h;
}

bool is_one_sided(const CampaignData& data, const Hypothesis& h) {
  const std::vector<Unknown> unknowns = make_unknowns(data, h);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (h.parameters[i].switches && unknowns[i].low >= h.reference[i]) return true;
  }
  return false;
}

std::vector<Unknown> make_unknowns(const CampaignData& data, const Hypothesis& h) {
  std::vector<Unknown> unknowns;
  unknowns.reserve(h.parameters.size());
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    Unknown u = make_parameter(data.runs, h.parameters[i].name);
    const SearchRange& range = h.parameters[i].range;
    u.low = std::max(u.low, std::min(range.low, h.reference[i]));
    u.high = std::min(u.high, std::max(range.high, h.reference[i]));
    unknowns.push_back(std::move(u));
  }
  return unknowns;
}

bool is_plausible(const CampaignData& data, const Hypothesis& h,
                  const std::vector<double>& values) {
  constexpr double kMaxTypical = 10.0, kMargin = 1e-3;
  const auto parameters = list_effect_parameters(*find_effect(h.effect), data.model());
  for (std::size_t i = 0; i < h.parameters.size(); ++i) {
    if (!h.parameters[i].switches) {
      // The low end of a search is where another effect begins.
      const bool is_searched = h.change == EffectChange::kAdded;
      if (is_searched && values[i] <= (1.0 + kMargin) * h.parameters[i].range.low) return false;
      continue;
    }
    // A removal has the switching parameters alone.
    const EffectParameter& p = **std::find_if(
        parameters.begin(), parameters.end(),
        [&](const EffectParameter* other) { return other->name == h.parameters[i].key; });
    const double size = std::abs(values[i] - p.neutral);
    const double low = std::max(p.low, h.parameters[i].range.low);
    const double most = values[i] < p.neutral ? p.neutral - low : p.high - p.neutral;
    if (size > 0.0 && size > (1.0 - kMargin) * most) return false;
    if (!data.has_inputs() && size > kMaxTypical * std::abs(p.typical - p.neutral)) return false;
  }
  return true;
}

bool is_corner(const std::string& place) { return find_corner(place) >= 0; }

EffectSettings list_effects_on(const CampaignData& data, const SharedValues& shared) {
  return set_unknowns(data.runs[0], shared.unknowns, shared.values).setup.effects();
}

std::vector<Hypothesis> list_hypotheses(const CampaignData& data, const SharedValues& shared) {
  const EffectSettings model_effects = list_effects_on(data, shared);
  const std::vector<Unknown>& free = shared.unknowns;
  const std::map<std::string, StrutMotion> motions = measure_motion(data, shared);
  const ModelInfo& model = data.model();
  std::vector<Hypothesis> list;
  for (const EffectInfo& effect : list_effects()) {
    if (effect.name == EffectName::kSensorBias)
      continue;  // a bias of every run and channel is always free
    const auto parameters = list_effect_parameters(effect, model);
    for (const std::string& place : list_effect_places(effect, model)) {
      if (contains(data.campaign.effects.exclude, effect.name, place)) continue;
      const OnAt on = find_on(model_effects, effect.name, place);
      if (on == OnAt::kOverlapping) continue;
      if ((effect.places & kOnChannel) != 0 && !is_compared(data, place)) continue;
      // With a single channel, an offset of the clock is the same as a delay of that sensor.
      if ((effect.places & kOnChannels) != 0 && !has_run_with_several_channels(data)) continue;
      const auto found = motions.find(find_axle(place));
      const StrutMotion motion = found == motions.end() ? StrutMotion{} : found->second;
      Hypothesis h{effect.name, place, {}, {}, EffectChange::kAdded, {}};
      for (const EffectParameter* p : parameters) {
        h.parameters.push_back({make_effect_parameter_name(effect, place, *p, model), p->name,
                                p->switches, choose_search_range(effect.name, p->name, motion)});
      }
      if (effect.name == EffectName::kTireEnveloping) {
        // No patch is shorter than the model can average over.
        const double footprint = data.runs.front().setup.car().vehicle.tire.footprint;
        h.parameters.front().range.low = kShortestFootprint - footprint;
      }
      if (is_own_parameter(data, h.parameters.front().name)) continue;
      const bool is_free = std::any_of(free.begin(), free.end(), [&](const Unknown& u) {
        return std::any_of(h.parameters.begin(), h.parameters.end(),
                           [&](const HypothesisParameter& p) { return p.name == u.name; });
      });
      if (is_free) continue;
      for (const EffectParameter* p : parameters) h.reference.push_back(p->neutral);
      if (on == OnAt::kPlace) {
        change_from_file(data, parameters, h);
      } else {
        h.beginnings = make_beginnings(parameters, choose_search_starts(effect.name, motion));
      }
      list.push_back(std::move(h));
    }
  }
  return list;
}

}  // namespace strut
