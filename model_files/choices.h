// The words for enumerations of the model in vehicle, rig and maneuver files.
#pragma once

#include <array>

#include "base/names/name_table.h"
#include "model/car/spec.h"
#include "model/scenario/input_signal.h"
#include "model/scenario/maneuver.h"

namespace strut {

inline constexpr std::array<Named<BumpShape>, 6> kBumpShapes = {
    {{BumpShape::kNone, "none"},
     {BumpShape::kArc, "arc"},
     {BumpShape::kHalfSine, "half_sine"},
     {BumpShape::kCosine, "cosine"},
     {BumpShape::kTrapezoid, "trapezoid"},
     {BumpShape::kTable, "table"}}};
static_assert(names_all(kBumpShapes, BumpShape::kTable));

inline constexpr std::array<Named<BumpSide>, 3> kBumpSides = {
    {{BumpSide::kBoth, "both"}, {BumpSide::kLeft, "left"}, {BumpSide::kRight, "right"}}};
static_assert(names_all(kBumpSides, BumpSide::kRight));

inline constexpr std::array<Named<TrimKind>, 2> kTrims = {
    {{TrimKind::kSteady, "steady"}, {TrimKind::kStatic, "static"}}};
static_assert(names_all(kTrims, TrimKind::kStatic));

inline constexpr std::array<Named<Interpolation>, 2> kInterpolations = {
    {{Interpolation::kSpline, "spline"}, {Interpolation::kLinear, "linear"}}};
static_assert(names_all(kInterpolations, Interpolation::kLinear));

inline constexpr std::array<Named<SuspensionKind>, 2> kSuspensions = {
    {{SuspensionKind::kMacPherson, "macpherson"}, {SuspensionKind::kMultilink, "multilink"}}};
static_assert(names_all(kSuspensions, SuspensionKind::kMultilink));

inline constexpr std::array<Named<ContactKind>, 2> kContacts = {
    {{ContactKind::kEnvelope, "envelope"}, {ContactKind::kPoint, "point"}}};
static_assert(names_all(kContacts, ContactKind::kPoint));

inline constexpr std::array<Named<PreloadKind>, 2> kPreloads = {
    {{PreloadKind::kFreeLength, "free_length"}, {PreloadKind::kTrimmed, "trimmed"}}};
static_assert(names_all(kPreloads, PreloadKind::kTrimmed));

}  // namespace strut
