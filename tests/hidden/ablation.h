// Trials with less data: without roughness, with fewer sensors, with one crossing.
#pragma once

#include <string>

#include "tests/hidden/trial.h"

namespace strut::hidden {

enum class Ablation {
  kNone,
  kNoRoughness,   // the road between the bumps is smooth
  kNoDeflection,  // the struts' deflections are not measured: no balance without the road
  kBodyOnly,      // the body's sensors alone
  kOneCrossing    // one run for fitting, besides the level road
};

/// "none", "no_roughness", "no_deflection", "body_only" or "one_crossing"; throws
/// std::invalid_argument for others.
Ablation make_ablation(const std::string& name);

/// Removes the ablation's data from a drawn trial. The hidden faults stay, except those of removed
/// sensors, and so does the grade, which is that of the whole kit.
void ablate(Ablation ablation, Kit& kit, Trial& trial);

}  // namespace strut::hidden
