// What the trials show with less: without roughness, with fewer sensors, with one crossing.
#pragma once

#include <string>

#include "tests/hidden/trial.h"

namespace strut::hidden {

enum class Ablation {
  kNone,
  kNoRoughness,   // the road between the bumps is smooth
  kNoDeflection,  // nothing tells the struts' deflections: no balance without the road
  kBodyOnly,      // the body's sensors alone
  kOneCrossing    // one run for fitting, level road aside
};

/// "none", "no_roughness", "no_deflection", "body_only" or "one_crossing"; throws
/// std::invalid_argument for others.
Ablation make_ablation(const std::string& name);

/// Leaves out of a drawn trial what the ablation says. What is hidden, and the grade, which is that
/// of the whole kit, stay; but for faults of sensors that are left out, which are nowhere then.
void ablate(Ablation ablation, Kit& kit, Trial& trial);

}  // namespace strut::hidden
