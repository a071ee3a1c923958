// Derivatives of runs with respect to parameters, by forward differentiation in lanes.
//
// A parameter acts on a run through the numbers of its prepared case: those of the vehicle, its
// tables, its road, its start, the places of bump and line. Their derivatives are central
// differences of cases prepared beside the case, which are smooth and cost no run; from there on
// the equations of motion, the trim, the integrator and its events are differentiated exactly
// (base/math/dual.h), along the branches that the run itself takes.
#pragma once

#include <array>

#include "model/kernel/simulation.h"

namespace strut {

/// Directions of one differentiated run.
inline constexpr std::size_t kDirections = 4;

/// Two cases on both sides of another along one parameter; one of them may be that case itself.
struct Neighbors {
  const PreparedCase* above = nullptr;  // null: no direction, derivatives are zero
  const PreparedCase* below = nullptr;
  double distance = 1.0;  // of the parameter between them, its unit
};

struct DifferentiatedCase {
  const PreparedCase* at = nullptr;
  std::array<Neighbors, kDirections> along{};
};

/// One instruction set's compiled differentiation.
struct DerivativeKernel {
  const char* isa;  // as in Kernel
  int lanes;        // W
  /// Runs up to W cases in lockstep with tables as closure; LaneResults::slopes holds kDirections
  /// directions. Throws ModelError for cases that may not share lanes, for another closure, and for
  /// neighbors that differ in what is_differentiable excludes.
  LaneResults (*run)(const DifferentiatedCase* cases, int count, const IntegrateOptions& options,
                     const SamplePlan& plan);
};

/// Kernels this processor can run, widest first; never empty.
const std::vector<DerivativeKernel>& list_derivative_kernels();

/// Whether the parameter between the neighbors of a case acts on it smoothly and by what is
/// differentiated. Not among it are the coefficients of the tire's Magic Formula, curves of damper
/// and tire, force maps, sensors, and the shape of a road with kinks. Not smooth is what switches
/// an effect on, and what acts on one side of a symmetric car: both wheels of an axle leave the
/// road in one event, which it splits in two.
bool is_differentiable(const PreparedCase& at, const Neighbors& neighbors);

}  // namespace strut
