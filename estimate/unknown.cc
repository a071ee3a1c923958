#include "estimate/unknown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/math/spread.h"
#include "base/text/format_number.h"
#include "base/text/nearest_name.h"
#include "model/error/model_error.h"
#include "model_files/read_model.h"

namespace strut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr char kGainSuffix[] = "_gain", kBiasSuffix[] = "_bias";
constexpr char kGainErrorSuffix[] = "_gain_error", kSkewSuffix[] = "_skew";

/// In units of the scale: distance of the lower bound from an open end of the allowed range, and
/// largest upper bound.
constexpr double kAboveLow = 1e-4, kReach = 1e4;

std::string describe_run(const Unknown& u) {
  return u.run == kEveryRun ? "" : fmt::format(" of run {}", u.run + 1);
}

Unknown make_gain(const std::string& name, int input) {
  Unknown u;
  u.kind = UnknownKind::kInputGain;
  u.name = name;
  u.unit = "1";
  u.input = input;
  u.start = 1.0;
  u.low = -100.0;
  u.high = 100.0;
  return u;
}

/// Corrects the recorded inputs, and scales their noise.
void correct_inputs(MeasuredRun& measured,
                    const std::array<InputCorrection, kMaxRigInputs>& corrections) {
  std::vector<InputSignal>& signals = measured.setup.rig().inputs;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const int input = find_input(measured.setup.info(), signals[k].channel);
    const InputCorrection& correction = corrections[static_cast<std::size_t>(input)];
    if (correction == InputCorrection{}) continue;
    correct_signal(signals[k], correction);
    if (k >= measured.input_noise.size()) continue;
    measured.input_noise[k].sigma *= std::abs(correction.gain);
  }
}

/// The spread of an input over the run's readings; 0 where the run lacks it.
double calc_input_spread(const MeasuredRun& run, const std::string& input) {
  std::vector<double> values;
  values.reserve(run.times.size());
  for (const InputSignal& signal : run.setup.rig().inputs) {
    if (signal.channel != input) continue;
    for (const double t : run.times) values.push_back(calc_signal(signal, t).value);
  }
  return calc_spread(values);
}

}  // namespace

Unknown make_parameter(const std::vector<MeasuredRun>& runs, const std::string& name, int run) {
  const Model& setup = runs.at(run == kEveryRun ? 0 : static_cast<std::size_t>(run)).setup;
  const Parameter& info = find_parameter(setup.info(), name);
  if (name == "duration") {
    throw InputError("duration: cannot be fitted; it is the length of the simulation");
  }
  Unknown u;
  u.name = name;
  u.unit = info.unit;
  u.run = run;
  u.start = get_parameter(setup, name);
  require_settable(setup, name);
  const double ordinary =
      info.typical > 0.0 ? info.typical : 0.5 * (info.allowed.high - info.allowed.low);
  u.scale = u.start != 0.0 ? std::abs(u.start) : ordinary;
  u.low = info.allowed.open_low ? info.allowed.low + kAboveLow * u.scale : info.allowed.low;
  const bool is_bounded = info.is_effect || u.start == 0.0;
  u.high = is_bounded ? info.allowed.high : std::min(info.allowed.high, kReach * u.scale);
  return u;
}

Unknown make_shared_unknown(const std::vector<MeasuredRun>& runs, const std::string& name) {
  const MeasuredRun& run = runs.at(0);
  const ModelInfo& model = run.setup.info();
  std::vector<std::string> plain, names;
  for (const Parameter* p : list_parameters(model)) {
    if (p->name == name) return make_parameter(runs, name);
    (p->is_effect ? names : plain).push_back(p->name);
  }
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    const int input = static_cast<int>(i);
    plain.push_back(model.inputs[i].name + kGainSuffix);
    if (plain.back() == name) return make_gain(name, input);
    plain.push_back(model.inputs[i].name + kBiasSuffix);
    if (plain.back() != name) continue;
    return make_input_bias(model, kEveryRun, {input, 0}, {},
                           calc_input_spread(run, model.inputs[i].name));
  }
  for (const MeasuredChannel& c : run.channels) {
    Unknown u = make_bias(model, kEveryRun, c.channel, {});
    u.scale = std::max(calc_spread(c.values), c.sigma);
    if (u.name == name) return u;
    plain.push_back(u.name);
  }
  names.insert(names.end(), plain.begin(), plain.end());
  throw InputError(fmt::format("'{}' cannot be free; allowed: {}, and parameters of effects{}",
                               name, join_names(plain), suggest_name(name, names)));
}

Unknown make_hit_time(int run, const Prior& prior) {
  Unknown u;
  u.kind = UnknownKind::kHitTime;
  u.name = kHitTimeName;
  u.unit = "s";
  u.run = run;
  u.start = prior.mean;
  u.scale = prior.sigma;
  u.low = prior.mean - kHitTimeReach * prior.sigma;
  u.high = prior.mean + kHitTimeReach * prior.sigma;
  u.prior = prior;
  return u;
}

Unknown make_bias(const ModelInfo& model, int run, int channel, const Prior& prior) {
  const ChannelInfo& info = model.channels[static_cast<std::size_t>(channel)];
  Unknown u;
  u.kind = UnknownKind::kBias;
  u.name = info.name + kBiasSuffix;
  u.unit = info.unit;
  u.run = run;
  u.channel = channel;
  u.start = prior.mean;
  u.scale = prior.informs() ? prior.sigma : 1.0;
  u.low = -kInfinity;
  u.high = kInfinity;
  u.prior = prior;
  return u;
}

Unknown make_input_bias(const ModelInfo& model, int run, const InputDerivative& sensor,
                        const Prior& prior, double scale) {
  const InputInfo& input = model.inputs[static_cast<std::size_t>(sensor.input)];
  const int channel = sensor.derivative == 0   ? find_channel(model, input.name)
                      : sensor.derivative == 1 ? input.rate
                                               : input.second_rate;
  STRUT_CHECK(channel >= 0, input.name + " has a channel for each of its sensors");
  Unknown u = make_bias(model, run, channel, prior);
  u.kind = UnknownKind::kInputBias;
  u.channel = -1;
  u.input = sensor.input;
  u.derivative = sensor.derivative;
  if (scale > 0.0) u.scale = scale;
  return u;
}

std::array<InputCorrection, kMaxRigInputs> list_corrections(const std::vector<Unknown>& unknowns,
                                                            const std::vector<double>& values,
                                                            int run) {
  std::array<InputCorrection, kMaxRigInputs> corrections;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (u.input < 0 || (u.run != kEveryRun && u.run != run)) continue;
    InputCorrection& c = corrections[static_cast<std::size_t>(u.input)];
    if (u.kind == UnknownKind::kInputGain) c.gain *= values[i];
    if (u.kind == UnknownKind::kInputBias) {
      c.offset[static_cast<std::size_t>(u.derivative)] -= values[i];
    }
  }
  for (InputCorrection& c : corrections) {
    for (double& offset : c.offset) offset *= c.gain;
  }
  return corrections;
}

Unknown make_sensor_unknown(UnknownKind kind, const ModelInfo& model, int run, int channel,
                            double sigma) {
  Unknown u = make_bias(model, run, channel, {0.0, sigma});
  const bool is_gain = kind == UnknownKind::kSensorGain;
  u.kind = kind;
  u.low = -kSensorReach * sigma;
  u.high = kSensorReach * sigma;
  u.name = model.channels[static_cast<std::size_t>(channel)].name +
           (is_gain ? kGainErrorSuffix : kSkewSuffix);
  u.unit = is_gain ? "1" : "s";
  return u;
}

Unknown make_map_unknown(const std::string& name, std::shared_ptr<const ForceMap> part,
                         const Prior& prior) {
  Unknown u;
  u.kind = UnknownKind::kForceMap;
  u.name = name;
  u.unit = "1";
  u.start = prior.mean;
  u.low = -kInfinity;
  u.high = kInfinity;
  u.prior = prior;
  u.part = std::move(part);
  return u;
}

void add_map_part(ForceMaps& maps, const ForceMap& part, double factor) {
  const auto found = std::find_if(maps.begin(), maps.end(),
                                  [&](const ForceMap& map) { return map.place == part.place; });
  const bool is_new = found == maps.end();
  ForceMap& map = is_new ? maps.emplace_back(part) : *found;
  if (is_new) map.coefficients.assign(part.coefficients.size(), 0.0);
  ForceMap grid = part;
  grid.coefficients = map.coefficients;
  if (!(grid == map)) {
    throw ModelError(fmt::format("force map{}: the part to be added has a different grid",
                                 part.place.empty() ? "" : " at " + part.place));
  }
  for (std::size_t i = 0; i < part.coefficients.size(); ++i) {
    map.coefficients[i] += factor * part.coefficients[i];
  }
}

bool is_among(const std::vector<Unknown>& unknowns, const std::string& name) {
  return std::any_of(unknowns.begin(), unknowns.end(),
                     [&](const Unknown& u) { return u.name == name; });
}

std::vector<double> list_starts(const std::vector<Unknown>& unknowns) {
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (const Unknown& u : unknowns) values.push_back(u.start);
  return values;
}

MeasuredRun set_unknowns(MeasuredRun measured, const std::vector<Unknown>& unknowns,
                         const std::vector<double>& values, int run) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (u.run != kEveryRun && u.run != run) continue;
    switch (u.kind) {
      case UnknownKind::kParameter:
        set_parameter(measured.setup, u.name, values[i]);
        break;
      case UnknownKind::kForceMap:
        add_map_part(measured.setup.force_maps(), *u.part, values[i]);
        break;
      case UnknownKind::kInitialState:
        set_initial_state(measured.setup.rig().rig, u.state, values[i]);
        break;
      case UnknownKind::kInputGain:  // below, all at once
      case UnknownKind::kInputBias:
      case UnknownKind::kHitTime:
      case UnknownKind::kBias:
      case UnknownKind::kSensorGain:
      case UnknownKind::kSensorSkew:
        break;
    }
  }
  if (measured.setup.info().is_driven_by_inputs()) {
    correct_inputs(measured, list_corrections(unknowns, values, run));
  }
  return measured;
}

void set_initial_state(RigSpec& rig, int state, double value) {
  const auto at = static_cast<std::size_t>(state);
  const std::size_t masses = get_rig_info(rig.kind).masses.size();
  (at < masses ? rig.initial_position[at] : rig.initial_velocity[at - masses]) = value;
}

void check_unknowns(const std::vector<Unknown>& unknowns, std::size_t run_count) {
  if (unknowns.empty()) throw InputError("fit: nothing is free; free at least one parameter");
  for (const Unknown& u : unknowns) {
    const auto same = [&](const Unknown& other) {
      return other.name == u.name &&
             (other.run == u.run || other.run == kEveryRun || u.run == kEveryRun);
    };
    const std::string name = u.name + describe_run(u);
    if (std::count_if(unknowns.begin(), unknowns.end(), same) > 1) {
      throw InputError(name + ": listed twice as free; must be listed once");
    }
    if (u.run != kEveryRun && (u.run < 0 || static_cast<std::size_t>(u.run) >= run_count)) {
      throw InputError(fmt::format("{}: there are only {} runs", name, run_count));
    }
    if (!(u.start >= u.low && u.start <= u.high)) {
      throw InputError(fmt::format("{} = {}: must start within [{}, {}]", name,
                                   format_number(u.start), format_number(u.low),
                                   format_number(u.high)));
    }
    if (!(u.prior.sigma > 0.0) || !(u.scale > 0.0)) {
      throw InputError(
          fmt::format("{}: sigma {} of its prior must be > 0", name, format_number(u.prior.sigma)));
    }
  }
}

}  // namespace strut
