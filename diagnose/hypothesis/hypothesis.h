// Hypotheses about errors of the model: every effect of the catalogue at every location where it
// may act, with start values that fit the measured motion.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"
#include "diagnose/hypothesis/search_starts.h"
#include "model/effects/catalogue.h"

namespace strut {

/// A parameter of a hypothesis.
struct HypothesisParameter {
  std::string name;      // as an unknown: "rear_damper_asymmetry"
  std::string key;       // as in a model file: "asymmetry"
  bool switches = true;  // whether it switches the effect: off if all such parameters are neutral;
                         // false: it only shapes the effect
  SearchRange range{};   // in which its value is looked for
};

/// Change of the model file by a hypothesis.
enum class EffectChange {
  kAdded,    // switches an effect on
  kChanged,  // frees the parameters of an effect that the file switches on
  kRemoved,  // switches it off
};

/// "added", "changed", "removed"
const char* get_name(EffectChange change);

/// "damper_asymmetry at rear"; without the place on a rig. An effect of the model file: "another
/// damper_asymmetry at rear", "without damper_asymmetry at rear".
std::string describe_effect(const std::string& effect, const std::string& place,
                            EffectChange change = EffectChange::kAdded);

struct Hypothesis {
  std::string effect, place;
  std::vector<HypothesisParameter> parameters;
  /// Start values of the parameters, close to `reference` but not equal. Several, since the shape
  /// of an effect determines which readings it changes.
  std::vector<std::vector<double>> beginnings;
  EffectChange change = EffectChange::kAdded;
  /// Values of the parameters without the hypothesis: neutral, or those of the model file.
  std::vector<double> reference;

  std::string describe() const;
};

/// Whether both concern the same effect at the same place.
bool is_same_effect(const Hypothesis& a, const Hypothesis& b);

/// Whether the model gives both the same equations, so that no data tell them apart: a lost stroke
/// and a joint's play of one strut without dry friction. `on`: the effects of the base.
bool are_identical(const Hypothesis& a, const Hypothesis& b, const EffectSettings& on);

/// The hypothesis that an effect of the model file is not there: its switching parameters are
/// neutral, and nothing of it is free.
Hypothesis make_removal(const CampaignData& data, const Hypothesis& changed);

/// Whether a parameter has values on one side of its reference only.
bool is_one_sided(const CampaignData& data, const Hypothesis& h);

/// One unknown per parameter of a hypothesis, which all runs share.
std::vector<Unknown> make_unknowns(const CampaignData& data, const Hypothesis& h);

/// Lists the hypotheses that exist in the campaign's model, except those that the campaign excludes
/// and those with a parameter among the unknowns of `shared`. An effect that is on
/// (list_effects_on) may be changed at its place; it may not be added at an overlapping one. Start
/// values are fractions of the struts' forces, deflections and velocities in the runs for fitting,
/// simulated at `shared`.
std::vector<Hypothesis> list_hypotheses(const CampaignData& data, const SharedValues& shared);

/// Whether these values are plausible: no switching parameter is at the limit of its range, where
/// a fit would leave it, nor a shape at the low end of its search; of a car every one is within ten
/// times its typical size. A rig has no typical size.
bool is_plausible(const CampaignData& data, const Hypothesis& h, const std::vector<double>& values);

/// Whether a place is one corner of an axle: "front_left", ...
bool is_corner(const std::string& place);

/// The effects switched on by the model's file and the values of shared unknowns.
EffectSettings list_effects_on(const CampaignData& data, const SharedValues& shared);

}  // namespace strut
