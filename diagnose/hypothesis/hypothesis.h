// What may be wrong with the model: every effect of the catalogue at every place where it may act,
// in sizes that fit the motion that was measured.
#pragma once

#include <string>
#include <vector>

#include "diagnose/baseline/baseline.h"
#include "model/effects/catalogue.h"

namespace strut {

/// A parameter of a hypothesis.
struct HypothesisParameter {
  std::string name;      // as an unknown: "rear_damper_asymmetry"
  std::string key;       // as in a model file: "asymmetry"
  bool switches = true;  // the effect vanishes where all that switch are neutral; else a mere shape
};

/// "damper_asymmetry at rear"; on a rig without the place.
std::string describe_effect(const std::string& effect, const std::string& place);

struct Hypothesis {
  std::string effect, place;
  std::vector<HypothesisParameter> parameters;
  /// Values of the parameters where a search may begin: small, not neutral. What a shape is
  /// decides where its effect is seen, so several are tried.
  std::vector<std::vector<double>> beginnings;

  std::string describe() const;
};

/// An unknown for each parameter of a hypothesis, that all runs share.
std::vector<Unknown> make_unknowns(const CampaignData& data, const Hypothesis& h);

/// All that exist in the campaign's model and are not switched on in `model_effects` already, nor
/// at a place that holds one that is. Sizes are shares of the strut's forces, deflections and
/// speeds in the runs for fitting, simulated at `shared`. Nor those of which a parameter is among
/// `free`.
std::vector<Hypothesis> list_hypotheses(const CampaignData& data, const SharedValues& shared,
                                        const EffectSettings& model_effects,
                                        const std::vector<Unknown>& free = {});

/// Whether parameters of these values may be those of a car: what switches is within ten times its
/// ordinary size. Anything on a rig, which has no ordinary size.
bool is_plausible(const CampaignData& data, const Hypothesis& h, const std::vector<double>& values);

/// "front_left", ...: one corner of an axle.
bool is_corner(const std::string& place);

/// Effects that the model's file and the values of unknowns switch on.
EffectSettings list_effects_on(const CampaignData& data, const SharedValues& shared);

}  // namespace strut
