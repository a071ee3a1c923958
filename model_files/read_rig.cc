#include "model_files/read_rig.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/format/toml_document.h"
#include "io/table/csv.h"
#include "model/error/model_error.h"
#include "model/rig/rig_system.h"
#include "model_files/choices.h"
#include "model_files/file_kind.h"
#include "model_files/parameters.h"
#include "model_files/read_effects.h"
#include "model_files/read_fitted.h"
#include "model_files/read_force_curve.h"
#include "model_files/read_force_maps.h"

namespace strut {

namespace {

constexpr std::array<Named<bool>, 2> kTireContacts = {  // RigSpec::unilateral_tire
    {{false, "bilateral"}, {true, "unilateral"}}};
static_assert(names_all(kTireContacts, true));

enum Shape : int { kFile, kSine, kChirp, kStep, kBump };
constexpr std::array<Named<Shape>, 5> kShapes = {
    {{kFile, "file"}, {kSine, "sine"}, {kChirp, "chirp"}, {kStep, "step"}, {kBump, "bump"}}};
static_assert(names_all(kShapes, kBump));

const Range kDuration = between(1e-3, 1e5, "s");
const Range kFrequency{.low = 0.0, .high = 1000.0, .open_low = true, .unit = "Hz"};
/// Limits the table of a chirp to less than a gigabyte.
constexpr double kMaxPeriods = 1e5;
const Range kInitialPosition = between(-10.0, 10.0, "m");
const Range kInitialVelocity = between(-100.0, 100.0, "m/s");

void add_effect_parameters(RigKind kind, const EffectInfo& effect, const std::string& place,
                           std::vector<RigParameter>& list) {
  const ModelInfo& model = get_rig_info(kind);
  const auto parameters = list_effect_parameters(effect, model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const EffectParameter& p = *parameters[i];
    list.push_back({make_effect_parameter(effect, place, p, model),
                    [&effect, &model, place, i](const RigSpec& spec) {
                      return get_effect_value(spec.effects, effect, model, place, i);
                    },
                    [&effect, &model, place, i](RigSpec& spec, double value) {
                      set_effect_value(spec.effects, effect, model, place, i, value);
                    }});
  }
}

std::vector<RigParameter> make_parameters(RigKind kind) {
  std::vector<RigParameter> list;
  for (const RigField& f : get_rig_info(kind).fields) {
    const auto field = f.field;
    list.push_back({f, [field](const RigSpec& spec) { return spec.*field; },
                    [field](RigSpec& spec, double value) { spec.*field = value; }});
  }
  for (const EffectInfo& effect : list_effects()) {
    for (const std::string& place : list_effect_places(effect, get_rig_info(kind))) {
      add_effect_parameters(kind, effect, place, list);
    }
  }
  return list;
}

std::vector<std::string> list_type_names() {
  std::vector<std::string> names;
  for (const RigInfo& rig : list_rigs()) names.push_back(rig.name);
  return names;
}

void read_initial(const Table& root, RigSpec& spec) {
  const RigInfo& rig = get_rig_info(spec.kind);
  const auto initial = rig.masses.empty() ? std::nullopt : root.find_table("initial");
  if (!initial) return;
  const auto name = [&](int channel) {
    return rig.channels[static_cast<std::size_t>(channel)].name;
  };
  for (std::size_t i = 0; i < rig.masses.size(); ++i) {
    const auto [position, velocity] = rig.masses[i];
    spec.initial_position[i] = initial->number_or(name(position), 0.0, kInitialPosition);
    spec.initial_velocity[i] = initial->number_or(name(velocity), 0.0, kInitialVelocity);
  }
}

/// Reads one column of a CSV file over its time column.
InputSignal read_recording(const Table& table, const std::string& channel) {
  const CsvTable csv = read_csv(table.file("file"));
  const std::vector<double>& times = csv.column(table.text_or("time", "time")).values;
  std::vector<double> values = csv.column(table.text_or("column", channel)).values;
  const double scale = table.number_or("scale", 1.0), offset = table.number_or("offset", 0.0);
  for (double& value : values) value = scale * value + offset;
  const int interpolation = table.choice_or("interpolation", 0, list_names(kInterpolations));
  return make_signal(channel, times, values, static_cast<Interpolation>(interpolation));
}

InputSignal read_waves(const Table& table, const std::string& channel, Shape shape,
                       double duration) {
  const double amplitude = table.number("amplitude");
  const bool chirp = shape == kChirp;
  const std::string begin_key = chirp ? "begin_frequency" : "frequency";
  const double begin = table.number(begin_key, kFrequency);
  const double end = chirp ? table.number("end_frequency", kFrequency) : begin;
  if (duration * std::max(begin, end) > kMaxPeriods) {
    throw table.error(end > begin ? "end_frequency" : begin_key,
                      fmt::format("must be at most {} Hz over {} s",
                                  format_number(kMaxPeriods / duration), format_number(duration)));
  }
  return make_chirp(channel, amplitude, begin, end, duration);
}

InputSignal read_shape(const Table& table, const std::string& channel, Shape shape,
                       double duration) {
  if (shape == kFile) return read_recording(table, channel);
  if (shape == kSine || shape == kChirp) return read_waves(table, channel, shape, duration);
  const double height = table.number("height");
  const double begin = table.number("begin", between(0.0, kDuration.high, "s"));
  if (shape == kStep) {
    return make_step(channel, height, begin, table.number("rise", between(1e-6, 1e3, "s")));
  }
  return make_bump(channel, height, begin, table.number("width", between(1e-6, 1e3, "s")));
}

/// `duration`: 0 where the file does not give it, which is allowed for recordings only.
InputSignal read_input(const Table& table, const std::string& channel, double duration) {
  const auto shape = static_cast<Shape>(table.choice("shape", list_names(kShapes)));
  if (shape != kFile && duration == 0.0) {
    throw table.error(
        "shape",
        "needs the maneuver's `duration`, which may be missing only where all inputs are files");
  }
  try {
    return read_shape(table, channel, shape, duration);
  } catch (const ModelError& e) {
    throw table.error(shape == kFile ? "file" : "shape", e.what());
  }
}

}  // namespace

std::optional<RigKind> find_rig_kind(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = document.root();
  if (!root.has("type")) return std::nullopt;
  const std::string type = root.text("type");
  for (const RigInfo& rig : list_rigs()) {
    if (rig.name == type) return rig.kind;
  }
  return std::nullopt;
}

RigSpec read_rig(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kModelFile);
  RigSpec spec;
  spec.kind = static_cast<RigKind>(root.choice("type", list_type_names()));
  spec.name = root.text_or("name", path.stem().string());
  const bool has_tire = get_rig_info(spec.kind).has(kHasTire);
  for (const RigField& f : get_rig_info(spec.kind).fields) {
    if (has_tire && f.name == "tire_stiffness" && root.has("tire_curve")) continue;
    spec.*f.field = f.default_value ? root.number_or(f.name, *f.default_value, f.allowed)
                                    : root.number(f.name, f.allowed);
  }
  if (has_tire) {
    spec.unilateral_tire = root.choice("tire_contact", list_names(kTireContacts)) == 1;
  }
  spec.damper_curve = read_damper_curve(root, "damper_curve", "damping");
  if (!spec.damper_curve.empty()) spec.damping = calc_curve_rate(spec.damper_curve);
  if (has_tire) {
    spec.tire_curve = read_tire_curve(root, "tire_curve", "tire_stiffness");
    if (!spec.tire_curve.empty()) spec.tire_stiffness = calc_curve_rate(spec.tire_curve);
  }
  read_initial(root, spec);
  read_fitted(root, spec);
  spec.effects = read_effects(root, get_rig_info(spec.kind));
  spec.force_maps = read_force_maps(root, get_rig_info(spec.kind));
  document.check_all_read();
  return spec;
}

const std::vector<RigParameter>& list_rig_parameters(RigKind kind) {
  static const std::vector<std::vector<RigParameter>> lists = [] {
    std::vector<std::vector<RigParameter>> by_kind;
    for (const RigInfo& rig : list_rigs()) by_kind.push_back(make_parameters(rig.kind));
    return by_kind;
  }();
  return lists[static_cast<std::size_t>(kind)];
}

const RigParameter& find_rig_parameter(RigKind kind, const std::string& name) {
  return find_listed(list_rig_parameters(kind), name);
}

void set_rig_parameter(RigSpec& spec, const std::string& name, double value) {
  const RigParameter& parameter = find_rig_parameter(spec.kind, name);
  check_value(parameter, value);
  parameter.set(spec, value);
}

void apply_rig_setting(RigSpec& spec, const std::string& setting) {
  const NamedValue given = parse_setting(setting);
  set_rig_parameter(spec, given.name, given.to_si(find_rig_parameter(spec.kind, given.name).unit));
}

RigManeuver read_rig_maneuver(const std::filesystem::path& path, RigKind kind) {
  const Document document(path);
  const Table root = open_root(document, kRigManeuverFile);
  RigManeuver maneuver;
  if (root.has("duration")) maneuver.duration = root.number("duration", kDuration);
  const double given = maneuver.duration;
  if (const auto input = root.find_table("input")) {
    for (const InputInfo& info : get_rig_info(kind).inputs) {
      const auto table = input->find_table(info.name);
      if (!table) continue;
      maneuver.inputs.push_back(read_input(*table, info.name, given));
      if (given == 0.0) {
        maneuver.duration = std::max(maneuver.duration, maneuver.inputs.back().end);
      }
    }
  }
  document.check_all_read();
  if (maneuver.duration <= 0.0) maneuver.duration = root.number("duration", kDuration);
  if (!kDuration.contains(maneuver.duration)) {
    throw root.error(fmt::format("a recording of {} s: {}", format_number(maneuver.duration),
                                 kDuration.describe()));
  }
  try {
    assign_rig_inputs(kind, maneuver.inputs);
  } catch (const ModelError& e) {
    throw InputError(fmt::format("{}: {}", path.string(), e.what()));
  }
  return maneuver;
}

}  // namespace strut
