// What a campaign knows of the catalogue's effects: the table [effects].
#pragma once

#include <string>
#include <vector>

#include "io/format/toml_document.h"
#include "model/info/model_info.h"
#include "model/model.h"

namespace strut {

/// An effect at one place of a model; "" on a rig.
struct EffectAtPlace {
  std::string effect, place;
};

struct CampaignEffects {
  /// Of which the diagnosis makes no hypothesis: the model is right about them.
  std::vector<EffectAtPlace> exclude;
  /// Known to be present: the baseline fits their parameters.
  std::vector<EffectAtPlace> on;
};

/// Reads `exclude` and `on`, lists of "EFFECT" (all places) and "EFFECT at PLACE". Throws
/// InputError with the nearest known name or the allowed places for those that the model does not
/// have, and for an effect that is in both lists.
CampaignEffects read_campaign_effects(const Table& root, const ModelInfo& model);

bool contains(const std::vector<EffectAtPlace>& list, const std::string& effect,
              const std::string& place);

/// The names of the parameters of an effect, as `[fit] free` has them.
std::vector<std::string> list_parameter_names(const EffectAtPlace& effect, const ModelInfo& model);

/// Switches on those effects of the list that the model's file does not: a small start value for
/// the fit.
void switch_on(const std::vector<EffectAtPlace>& effects, Model& model);

}  // namespace strut
