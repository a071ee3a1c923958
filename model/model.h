// The subject of a simulation: a car in a maneuver, or a rig under its inputs. Its ModelInfo
// describes its capabilities.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "model/car/car_info.h"
#include "model/car/case.h"
#include "model/rig/rig_info.h"

namespace strut {

class Model {
 public:
  Model(Case c) : case_(std::move(c)) {}     // NOLINT(google-explicit-constructor)
  Model(RigCase c) : case_(std::move(c)) {}  // NOLINT(google-explicit-constructor)

  const ModelInfo& info() const;
  const EffectSettings& effects() const;
  EffectSettings& effects();
  const ForceMaps& force_maps() const;
  ForceMaps& force_maps();

  /// The car and its maneuver; throws CheckError for a rig.
  const Case& car() const;
  Case& car();
  /// The rig and its inputs; throws CheckError for a car.
  const RigCase& rig() const;
  RigCase& rig();

  /// Highest undamped natural frequency of a rig's linear parts [rad/s]; 0 for a car.
  double calc_fastest_mode() const;

  /// Calls `visitor` with the Case or RigCase, for features that only one of them has.
  template <class Visitor>
  decltype(auto) visit(const Visitor& visitor) const {
    return std::visit(visitor, case_);
  }
  template <class Visitor>
  decltype(auto) visit(const Visitor& visitor) {
    return std::visit(visitor, case_);
  }

 private:
  std::variant<Case, RigCase> case_;
};

/// Every kind of model: the car, then the rigs.
const std::vector<const ModelInfo*>& list_models();

}  // namespace strut
