// Likeness of hidden faults to the causes that the catalogue knows, in the generator's own forms.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/hidden/detect.h"

namespace strut::hidden {

/// A fault that the catalogue knows, at a place, with the direction in which it moves the whitened
/// runs after all adjustments (a unit vector).
struct KnownCause {
  FaultSetting setting;
  Eigen::VectorXd direction;
};

/// All known causes of a kit at a truth, each at a small magnitude.
std::vector<KnownCause> list_known_causes(const Detector& detector);

/// Names of a cause in a verdict.
struct CauseName {
  std::string effect, place;
};

/// Cosine from which on two causes are one class: to tell them apart takes a ratio that is ten
/// times higher than that of their detection.
inline constexpr double kSameClass = 0.995;

/// Known causes of the same class as a fault, other than its own name; a mount for a worn joint,
/// whose metal gives way.
std::vector<CauseName> list_twins(const Kit& kit, const FaultSetting& fault,
                                  const Eigen::VectorXd& residual,
                                  const std::vector<KnownCause>& causes);

/// Norm of what no single known cause takes of a fit's residual, each with its best magnitude and
/// an allowed sign. The forms are fixed: the catalogue's free shapes can imitate more.
double calc_beyond_one(const Eigen::VectorXd& residual, const std::vector<KnownCause>& causes);

/// The same for any two known causes, except pairs that are classes of both `hidden` residuals.
double calc_beyond_two(const Eigen::VectorXd& residual, const std::vector<KnownCause>& causes,
                       const std::vector<Eigen::VectorXd>& hidden);

}  // namespace strut::hidden
