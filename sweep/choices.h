// Names of the choices that a sweep offers, in files and on the command line.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/names/name_table.h"
#include "model/kernel/simulation.h"
#include "sweep/request.h"

namespace strut {

/// The steppers in the order of Stepper, then Solver::kCvode.
enum class Integrator { kRk4, kAbm4, kCvode };
inline constexpr std::array<Named<Integrator>, 3> kIntegrators = {
    {{Integrator::kRk4, "rk4"}, {Integrator::kAbm4, "abm4"}, {Integrator::kCvode, "cvode"}}};
static_assert(names_all(kIntegrators, Integrator::kCvode));

inline constexpr std::array<Named<Closure>, 2> kClosures = {
    {{Closure::kNewton, "newton"}, {Closure::kTable, "table"}}};
static_assert(names_all(kClosures, Closure::kTable));

inline constexpr std::array<Named<SpinTreatment>, 2> kSpins = {
    {{SpinTreatment::kExponential, "exponential"}, {SpinTreatment::kExplicit, "explicit"}}};
static_assert(names_all(kSpins, SpinTreatment::kExplicit));

inline constexpr std::array<Named<SampleMethod>, 3> kSampleMethods = {
    {{SampleMethod::kGrid, "grid"},
     {SampleMethod::kLatinHypercube, "latin_hypercube"},
     {SampleMethod::kSobol, "sobol"}}};
static_assert(names_all(kSampleMethods, SampleMethod::kSobol));

/// Events at which a snapshot is taken.
inline const std::vector<std::string> kInstants = {"rear_wheels_on_bump"};
/// Stratification by the mean relative loss over the axes.
inline const std::string kDegradation = "degradation";

constexpr const char* get_name(Stepper stepper) {
  return find_name(kIntegrators, static_cast<Integrator>(stepper));
}

/// The stepper of that name; `integrator` must not be kCvode.
constexpr Stepper to_stepper(Integrator integrator) { return static_cast<Stepper>(integrator); }
static_assert(to_stepper(Integrator::kRk4) == Stepper::kRk4 &&
              to_stepper(Integrator::kAbm4) == Stepper::kAbm4);

inline constexpr double kMaxStep = 0.02;  // s; a wheel hop has a period of 80 ms

}  // namespace strut
