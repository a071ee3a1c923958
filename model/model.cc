#include "model/model.h"

#include "base/error/check.h"

namespace strut {

const ModelInfo& Model::info() const {
  const auto* rig = std::get_if<RigCase>(&case_);
  return rig == nullptr ? get_car_info() : get_rig_info(rig->rig.kind);
}

const EffectSettings& Model::effects() const {
  const auto* rig = std::get_if<RigCase>(&case_);
  return rig == nullptr ? car().vehicle.effects : rig->rig.effects;
}

EffectSettings& Model::effects() {
  return const_cast<EffectSettings&>(std::as_const(*this).effects());
}

const ForceMaps& Model::force_maps() const {
  const auto* rig = std::get_if<RigCase>(&case_);
  return rig == nullptr ? car().vehicle.force_maps : rig->rig.force_maps;
}

ForceMaps& Model::force_maps() { return const_cast<ForceMaps&>(std::as_const(*this).force_maps()); }

const Case& Model::car() const {
  const auto* car = std::get_if<Case>(&case_);
  STRUT_CHECK(car != nullptr, "Model::car: the model is a rig, which has no maneuver");
  return *car;
}

Case& Model::car() { return const_cast<Case&>(std::as_const(*this).car()); }

const RigCase& Model::rig() const {
  const auto* rig = std::get_if<RigCase>(&case_);
  STRUT_CHECK(rig != nullptr, "Model::rig: the model is a car, which has no recorded inputs");
  return *rig;
}

RigCase& Model::rig() { return const_cast<RigCase&>(std::as_const(*this).rig()); }

double Model::calc_fastest_mode() const {
  const auto* rig = std::get_if<RigCase>(&case_);
  return rig == nullptr ? 0.0 : get_rig_info(rig->rig.kind).calc_fastest_mode(rig->rig);
}

const std::vector<const ModelInfo*>& list_models() {
  static const std::vector<const ModelInfo*> models = [] {
    std::vector<const ModelInfo*> list = {&get_car_info()};
    for (const RigInfo& rig : list_rigs()) list.push_back(&rig);
    return list;
  }();
  return models;
}

}  // namespace strut
