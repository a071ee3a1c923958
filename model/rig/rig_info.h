// The kinds of rigs and their parts, each listed once. Readers, help texts, fits and diagnosis
// derive from the list. A new rig is a row in rig_info.cc and its equations in rig_system.h.
#pragma once

#include <vector>

#include "model/info/model_info.h"
#include "model/info/parameter.h"
#include "model/rig/rig_channels.h"
#include "model/rig/rig_spec.h"

namespace strut {

/// A parameter of a rig and its field.
struct RigField : Parameter {
  double RigSpec::*field;
};

struct RigInfo : ModelInfo {
  RigKind kind;
  std::vector<RigField> fields;
  /// Highest undamped natural frequency of the linear parts [rad/s]; 0 without masses.
  double (*calc_fastest_mode)(const RigSpec&);
};

/// In RigKind order.
const std::vector<RigInfo>& list_rigs();
inline const RigInfo& get_rig_info(RigKind kind) {
  return list_rigs()[static_cast<std::size_t>(kind)];
}

/// Throws ModelError with name, value and allowed range.
void validate(const RigSpec& spec);

}  // namespace strut
