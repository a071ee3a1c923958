// The subject of a simulation: a car in a maneuver, or a rig under its inputs. Its ModelInfo says
// what it can do.
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
  Model(Case c) : of_(std::move(c)) {}     // NOLINT(google-explicit-constructor)
  Model(RigCase c) : of_(std::move(c)) {}  // NOLINT(google-explicit-constructor)

  const ModelInfo& info() const;
  const EffectSettings& effects() const;
  EffectSettings& effects();
  const ForceMaps& force_maps() const;
  ForceMaps& force_maps();

  /// The car and its maneuver, of a model that no recorded input drives; CheckError of others.
  const Case& car() const;
  Case& car();
  /// The rig and its inputs, of a model that these drive; CheckError of others.
  const RigCase& rig() const;
  RigCase& rig();

  /// The highest undamped natural frequency [rad/s] as far as a rig's linear parts tell; else 0.
  double calc_fastest_mode() const;

  /// Calls `visitor` with the Case or RigCase: for what only one of them has.
  template <class Visitor>
  decltype(auto) visit(const Visitor& visitor) const {
    return std::visit(visitor, of_);
  }
  template <class Visitor>
  decltype(auto) visit(const Visitor& visitor) {
    return std::visit(visitor, of_);
  }

 private:
  std::variant<Case, RigCase> of_;
};

/// Every kind of model: the car, then the rigs.
const std::vector<const ModelInfo*>& list_models();

}  // namespace strut
