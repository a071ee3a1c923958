// A rig and its maneuver from their TOML files. Example of a program that simulates one:
//
//   if (const auto kind = find_rig_kind(vehicle_path)) {
//     const RigSpec rig = read_rig(vehicle_path);
//     const RigManeuver maneuver = read_rig_maneuver(maneuver_path, *kind);
//     SamplePlan plan{.duration = maneuver.duration, .interval = 1e-3};
//     const LaneResults run = simulate_rig(rig, maneuver.inputs, StepOptions{}, plan);
//     // run.get_sample(sample, i): get_rig_info(*kind).channels[i]
//   }
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "model/rig/rigs.h"
#include "model_files/parameter.h"

namespace strut {

/// The rig that a vehicle file's `type` names; nothing where the type is not a rig or missing.
/// Throws InputError where the file cannot be parsed.
std::optional<RigKind> find_rig_kind(const std::filesystem::path& path);

/// Reads a rig's file: `type`, `name`, the parameters of RigInfo::fields, for a quarter car
/// `tire_contact` ("bilateral" or "unilateral"), the table [initial] with the initial offsets from
/// rest (`sprung_position`, ... or `position`, `velocity`), effects (read_effects.h) and a force
/// map (read_force_maps.h). Throws InputError with file, line, key, value and allowed values.
RigSpec read_rig(const std::filesystem::path& path);

using RigParameter = ParameterOf<RigSpec>;

/// The parameters of RigInfo::fields, then those of the effects of this kind of rig.
const std::vector<RigParameter>& list_rig_parameters(RigKind kind);

/// Throws InputError with the nearest known name.
const RigParameter& find_rig_parameter(RigKind kind, const std::string& name);

/// Throws InputError with name, value and allowed range, or with the nearest known name.
void set_rig_parameter(RigSpec& spec, const std::string& name, double value);
/// Applies "name=value", in the parameter's unit or the one given. Throws InputError likewise.
void apply_rig_setting(RigSpec& spec, const std::string& setting);

/// Reads the maneuver of a rig: `duration` [s] and, for each input that drives it, a table
///
///   [input.road_position]
///   shape = "file"              # columns of a CSV file, interpolated between its own times
///   file = "chirp_A1.csv"
///   time = "t_s"                # name of its time column; default "time"
///   column = "z_road_m"         # default: the input's name
///   scale = 1.0                 # input = scale * column + offset: unit, sign, bias
///   offset = 0.0
///   interpolation = "spline"    # or "linear"
///
/// or shape = "sine" (amplitude, frequency), "chirp" (amplitude, begin_frequency, end_frequency),
/// "step" (height, begin, rise), "bump" (height, begin, width). Without `duration` the longest
/// recording determines it. Throws InputError.
RigManeuver read_rig_maneuver(const std::filesystem::path& path, RigKind kind);

}  // namespace strut
