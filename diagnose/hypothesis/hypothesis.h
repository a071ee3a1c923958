// Hypotheses about errors of the model: every effect of the catalogue at every location where it
// may act, with start values that fit the measured motion.
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
  bool switches = true;  // whether it switches the effect: off if all such parameters are neutral;
                         // false: it only shapes the effect
};

/// "damper_asymmetry at rear"; without the place on a rig.
std::string describe_effect(const std::string& effect, const std::string& place);

struct Hypothesis {
  std::string effect, place;
  std::vector<HypothesisParameter> parameters;
  /// Start values of the parameters, small but not neutral. Several, since the shape of an effect
  /// determines which readings it changes.
  std::vector<std::vector<double>> beginnings;

  std::string describe() const;
};

/// One unknown per parameter of a hypothesis, which all runs share.
std::vector<Unknown> make_unknowns(const CampaignData& data, const Hypothesis& h);

/// Lists the hypotheses that exist in the campaign's model, except effects that `model_effects`
/// switches on at an overlapping place, and those with a parameter among `free`. Start values are
/// fractions of the struts' forces, deflections and velocities in the runs for fitting, simulated
/// at `shared`.
std::vector<Hypothesis> list_hypotheses(const CampaignData& data, const SharedValues& shared,
                                        const EffectSettings& model_effects,
                                        const std::vector<Unknown>& free = {});

/// Whether these values are plausible for a car: every switching parameter within ten times its
/// typical size. Always true for a rig, which has no typical size.
bool is_plausible(const CampaignData& data, const Hypothesis& h, const std::vector<double>& values);

/// Whether a place is one corner of an axle: "front_left", ...
bool is_corner(const std::string& place);

/// The effects switched on by the model's file and the values of shared unknowns.
EffectSettings list_effects_on(const CampaignData& data, const SharedValues& shared);

}  // namespace strut
