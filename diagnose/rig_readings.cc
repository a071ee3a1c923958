#include "diagnose/rig_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/local_cubic.h"
#include "diagnose/run_readings.h"
#include "diagnose/sampled_curve.h"
#include "diagnose/spread.h"
#include "io/config.h"
#include "io/nearest_name.h"
#include "model/effects/sensors.h"
#include "model/effects/strut_numbers.h"
#include "model/integrate/rig_system.h"
#include "model/kernel/simulation.h"
#include "model/parallel/team.h"
#include "model/vehicle/model_error.h"
#include "sweep/read_rig.h"

namespace strut {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr char kGain[] = "_gain", kBias[] = "_bias", kInitial[] = "initial_";

/// How a run is sampled: at its own times where they are even, else finely enough to interpolate.
struct RigSampling {
  double interval = 0.0, step = 0.0;
  bool even = false;
};

RigSampling choose_sampling(const RigRun& run, const RigSpec& spec, const RigOptions& options) {
  const double n = static_cast<double>(run.times.size() - 1);
  const double mean = run.times.back() / n, mode = calc_fastest_mode(spec);
  const double longest =
      mode > 0.0 ? std::min(options.longest_step, 0.1 / mode) : options.longest_step;
  RigSampling s;
  s.even = true;
  for (std::size_t i = 0; i < run.times.size() && s.even; ++i) {
    s.even = std::abs(run.times[i] - mean * static_cast<double>(i)) < 1e-6 * mean;
  }
  s.step = mean / std::ceil(mean / longest - 1e-9);
  s.interval = s.even ? mean : s.step;
  return s;
}

/// The sampling with as many more steps as a lost stroke of the strut takes: a short one is crossed
/// in a fraction of a millisecond, and what a step passes over it never feels. Masses do not feel
/// the shortest, a dynamometer's force shows them all.
RigSampling refine(RigSampling sampling, const RigSpec& spec) {
  constexpr double kStepsOfContact = 4.0;
  const double most = spec.kind == RigKind::kStrutRig ? 16.0 : 8.0;
  const EffectValues values{spec.effects, get_model_kind(spec.kind)};
  const double play = make_strut_effect_numbers(values, "", {}).series.play;
  if (play <= 0.0) return sampling;
  const double longest = kStepsOfContact / calc_contact_rate(play);
  sampling.step /= std::clamp(std::ceil(sampling.step / longest), 1.0, most);
  return sampling;
}

/// A run's setup with its unknowns set, and what its inputs are multiplied by.
struct RigVariant {
  RigSpec spec;
  std::array<double, kMaxRigInputs> gain;  // in the order of list_rig_inputs
};

bool belongs(const Unknown& u, int run) { return u.run == kEveryRun || u.run == run; }

double get_gain(const RigVariant& variant, const std::string& input) {
  const std::vector<RigInputInfo>& inputs = list_rig_inputs(variant.spec.kind);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i].name == input) return variant.gain[i];
  }
  return 1.0;
}

std::vector<InputSignal> scale_inputs(const RigRun& run, const RigVariant& variant) {
  std::vector<InputSignal> scaled = run.inputs;
  for (InputSignal& signal : scaled) scale_signal(signal, get_gain(variant, signal.channel));
  return scaled;
}

RigVariant make_variant(const RigRun& run, int index, const std::vector<Unknown>& unknowns,
                        const std::vector<double>& values) {
  RigVariant variant{run.setup, {}};
  variant.gain.fill(1.0);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (!belongs(u, index)) continue;
    if (u.kind == UnknownKind::kParameter) set_rig_parameter(variant.spec, u.name, values[i]);
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(variant.spec.force_maps, *u.part, values[i]);
    }
    if (u.kind == UnknownKind::kInputGain) {
      variant.gain[static_cast<std::size_t>(u.channel)] *= values[i];
    }
    if (u.kind == UnknownKind::kInitialState) {
      const bool rate = u.channel >= kRigCoordinates;
      const auto at = static_cast<std::size_t>(u.channel - (rate ? kRigCoordinates : 0));
      (rate ? variant.spec.initial_velocity : variant.spec.initial_position)[at] = values[i];
    }
  }
  return variant;
}

/// What is to be simulated of a run.
struct RigCase {
  const RigRun* run = nullptr;
  RigVariant variant;
  RigSampling sampling;
  std::string failure;  // why it cannot be

  RigCase(const RigRun& of, int index, const std::vector<Unknown>& unknowns,
          const std::vector<double>& values, const RigOptions& options)
      : run(&of) {
    try {
      variant = make_variant(of, index, unknowns, values);
      sampling = refine(choose_sampling(of, of.setup, options), variant.spec);
    } catch (const InputError& e) {  // out of a parameter's range
      failure = of.name + ": " + e.what();
    }
  }

  bool may_share_lanes(const RigCase& other) const {
    return run == other.run && variant.gain == other.variant.gain &&
           sampling.step == other.sampling.step && failure.empty() && other.failure.empty();
  }
};

/// A simulation, read at the run's times.
class RigResult {
 public:
  RigResult() = default;
  RigResult(const RigCase& c, const LaneResults& results, int lane)
      : run_(c.run),
        sampling_(c.sampling),
        channels_(list_rig_channels(c.run->setup.kind).size()),
        count_(static_cast<std::size_t>(results.sample_count)) {
    const auto at = static_cast<std::size_t>(lane);
    if (results.status[at] != 0) {
      failure_ = run_->name +
                 ": the simulation ends at t = " + format_rounded(results.failure_time[at]) +
                 " s: the motion is not finite";
      return;
    }
    const auto lanes = static_cast<std::size_t>(results.lanes);
    history_.resize(count_ * channels_);
    for (std::size_t i = 0; i < history_.size(); ++i) history_[i] = results.history[i * lanes + at];
    read_sensors(c.variant.spec);
  }
  explicit RigResult(std::string failure) : failure_(std::move(failure)) {}

  const std::string& failure() const { return failure_; }

  /// NaN where the simulation cannot be interpolated.
  double read(std::size_t time, std::size_t channel) const {
    const auto get = [&](std::size_t sample) { return history_[sample * channels_ + channel]; };
    if (sampling_.even) return time < count_ ? get(time) : kNan;
    const double at = run_->times[time] / sampling_.interval;
    const auto index = static_cast<std::size_t>(at);
    if (index < kCurveMargin || index + 1 + kCurveMargin >= count_) return kNan;
    return interpolate_curve(get, index, at - static_cast<double>(index), sampling_.interval).value;
  }

 private:
  /// Replaces what the channels are by what their sensors read.
  void read_sensors(const RigSpec& spec) {
    if (spec.effects.empty()) return;
    for (std::size_t c = 0; c < channels_; ++c) {
      std::vector<double> series(count_);
      for (std::size_t i = 0; i < count_; ++i) series[i] = history_[i * channels_ + c];
      series = read_sensor(spec.effects, list_rig_channels(spec.kind)[c].name, sampling_.interval,
                           std::move(series));
      for (std::size_t i = 0; i < count_; ++i) history_[i * channels_ + c] = series[i];
    }
  }

  const RigRun* run_ = nullptr;
  RigSampling sampling_;
  std::size_t channels_ = 0, count_ = 0;
  std::vector<double> history_;  // [sample][channel]
  std::string failure_;
};

/// Simulates cases that may share lanes, together if the processor has as many; one alone in
/// double.
void simulate_together(const RigCase* cases, RigResult* results, int count) {
  constexpr double kMarginSteps = 4.0;
  const RigRun& run = *cases[0].run;
  const RigSampling& sampling = cases[0].sampling;
  StepOptions step;
  step.step = sampling.step;
  SamplePlan plan;
  plan.interval = sampling.interval;
  plan.duration = run.times.back() + (sampling.even ? 0.0 : kMarginSteps * sampling.step);
  plan.snapshot = false;
  const std::vector<InputSignal> inputs = scale_inputs(run, cases[0].variant);
  std::vector<const RigSpec*> specs;
  specs.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) specs.push_back(&cases[i].variant.spec);
  try {
    const LaneResults lanes =
        count == 1 ? simulate_rig(*specs[0], inputs, step, plan)
                   : list_kernels().front().run_rigs(specs.data(), count, inputs, step, plan);
    for (int i = 0; i < count; ++i) results[i] = RigResult(cases[i], lanes, i);
  } catch (const ModelError& e) {
    if (count == 1) {
      results[0] = RigResult(run.name + ": " + e.what());
      return;
    }
    for (int i = 0; i < count; ++i) simulate_together(cases + i, results + i, 1);
  }
}

std::vector<RigResult> simulate_cases(const std::vector<RigCase>& cases, int threads) {
  const auto width = static_cast<std::size_t>(list_kernels().front().lanes);
  std::vector<RigResult> results(cases.size());
  std::vector<std::size_t> begin;  // of each batch
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const bool joins =
        !begin.empty() && i - begin.back() < width && cases[begin.back()].may_share_lanes(cases[i]);
    if (!joins) begin.push_back(i);
  }
  share_items(threads, begin.size(), [&](std::size_t k, int /*thread*/) {
    const std::size_t first = begin[k], end = k + 1 < begin.size() ? begin[k + 1] : cases.size();
    if (!cases[first].failure.empty()) {
      results[first] = RigResult(cases[first].failure);
      return;
    }
    simulate_together(&cases[first], &results[first], static_cast<int>(end - first));
  });
  return results;
}

std::vector<std::string> list_unknown_names(const RigRun& run) {
  std::vector<std::string> names;
  for (const RigParameter& info : list_rig_settings(run.setup.kind)) {
    if (!info.is_effect) names.push_back(info.name);
  }
  for (const RigInputInfo& info : list_rig_inputs(run.setup.kind))
    names.push_back(info.name + kGain);
  for (const MeasuredChannel& c : run.channels) {
    names.push_back(list_rig_channels(run.setup.kind)[static_cast<std::size_t>(c.channel)].name +
                    kBias);
  }
  return names;
}

Unknown make_gain(const std::string& name, int input) {
  Unknown u;
  u.kind = UnknownKind::kInputGain;
  u.name = name;
  u.unit = "1";
  u.channel = input;
  u.start = 1.0;
  u.low = -100.0;
  u.high = 100.0;
  return u;
}

Unknown make_rig_bias(const RigRun& run, int index, const MeasuredChannel& c) {
  const ChannelInfo& info = list_rig_channels(run.setup.kind)[static_cast<std::size_t>(c.channel)];
  Unknown u;
  u.kind = UnknownKind::kBias;
  u.name = info.name + kBias;
  u.unit = info.unit;
  u.run = index;
  u.channel = c.channel;
  u.scale = std::max(calc_spread(c.values), c.sigma);
  u.low = -std::numeric_limits<double>::infinity();
  u.high = std::numeric_limits<double>::infinity();
  return u;
}

/// Where the parameter's lower bound itself is not allowed.
constexpr double kAboveLow = 1e-4, kReach = 1e4;

/// An effect of the catalogue begins where it vanishes and is as large as such effects are.
Unknown make_rig_parameter(const RigRun& run, const RigParameter& info) {
  Unknown u;
  u.name = info.name;
  u.unit = info.unit;
  u.start = info.get(run.setup);
  u.scale = u.start != 0.0 ? std::abs(u.start) : info.typical != 0.0 ? info.typical : 1.0;
  u.low = info.allowed.open_low ? info.allowed.low + kAboveLow * u.scale : info.allowed.low;
  const bool bounded = info.is_effect || u.start == 0.0;
  u.high = bounded ? info.allowed.high : std::min(info.allowed.high, kReach * u.scale);
  return u;
}

/// The first reading of a coordinate's position, less the road's; 0 where it is not measured.
double read_first_offset(const RigRun& run, const std::string& name) {
  const std::vector<ChannelInfo>& infos = list_rig_channels(run.setup.kind);
  for (const MeasuredChannel& c : run.channels) {
    if (infos[static_cast<std::size_t>(c.channel)].name != name) continue;
    const auto there =
        std::find_if(c.values.begin(), c.values.end(), [](double v) { return std::isfinite(v); });
    if (there == c.values.end()) return 0.0;
    double ground = 0.0;
    for (const InputSignal& input : run.inputs) {
      if (input.channel == "road_position") ground = calc_signal(input, 0.0).value;
    }
    return *there - ground;
  }
  return 0.0;
}

}  // namespace

double calc_fastest_mode(const RigSpec& spec) {
  switch (spec.kind) {
    case RigKind::kQuarterCar:
      return std::sqrt((spec.stiffness + spec.tire_stiffness) / spec.unsprung_mass);
    case RigKind::kSingleMass:
      return std::sqrt(spec.stiffness / spec.sprung_mass);
    case RigKind::kStrutRig:
      break;
  }
  return 0.0;
}

double get_rig_parameter(const RigSpec& spec, const std::string& name) {
  return find_rig_parameter(spec.kind, name).get(spec);
}

void scale_signal(InputSignal& signal, double factor) {
  for (SignalCell& cell : signal.cells) {
    for (double* c : {&cell.c0, &cell.c1, &cell.c2, &cell.c3}) *c *= factor;
  }
}

InputSignal make_sampled_input(const std::string& channel, const std::vector<double>& times,
                               const std::vector<double>& values, double half_width) {
  if (half_width <= 0.0) return make_signal(channel, times, values, Interpolation::kSpline);
  const SmoothCurve curve = calc_local_cubic(times, values, half_width, CurveEnds::kOneSided);
  return make_signal(channel, times, curve.value, curve.rate);
}

RigCurves simulate_rig_run(const RigRun& run, int index, const std::vector<Unknown>& unknowns,
                           const std::vector<double>& values, const RigOptions& options) {
  const RigCase only(run, index, unknowns, values, options);
  if (!only.failure.empty()) throw InputError(only.failure);
  RigResult result;
  simulate_together(&only, &result, 1);
  RigCurves curves{result.failure(), {}};
  if (!curves.failure.empty()) return curves;
  const std::size_t count = list_rig_channels(run.setup.kind).size();
  curves.channel.assign(count, std::vector<double>(run.times.size()));
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t t = 0; t < run.times.size(); ++t) curves.channel[c][t] = result.read(t, c);
  }
  return curves;
}

RigRun set_rig_unknowns(const RigRun& run, const std::vector<Unknown>& unknowns,
                        const std::vector<double>& values) {
  const RigVariant variant = make_variant(run, 0, unknowns, values);
  RigRun changed = run;
  changed.setup = variant.spec;
  changed.inputs = scale_inputs(run, variant);
  // What an input was measured with is scaled with it.
  for (std::size_t k = 0; k < run.input_noise.size(); ++k) {
    changed.input_noise[k].sigma *= std::abs(get_gain(variant, run.inputs[k].channel));
  }
  return changed;
}

RigReadings::RigReadings(std::vector<RigRun> runs, std::vector<Unknown> unknowns,
                         const RigOptions& options)
    : ReadingModel(std::move(unknowns)), runs_(std::move(runs)), options_(options) {
  if (runs_.empty()) throw InputError("fit: no measurement");
  check_unknowns(unknowns_, runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const RigRun& run = runs_[r];
    channels_.emplace_back();
    for (const MeasuredChannel& c : run.channels) channels_[r].push_back(c.channel);
    begin_.push_back(readings_.size());
    const bool even = choose_sampling(run, run.setup, options_).even;
    const double step = choose_sampling(run, run.setup, options_).interval;
    for (std::size_t t = 0; t < run.times.size(); ++t) {
      const bool inside = even || run.times[t] >= static_cast<double>(kCurveMargin) * step;
      if (!inside) outside_count_ += run.channels.size();
      for (std::size_t c = 0; inside && c < run.channels.size(); ++c) {
        if (std::isfinite(run.channels[c].values[t])) readings_.push_back({r, t, c});
      }
    }
  }
  begin_.push_back(readings_.size());
  finish(runs_.front().name);
}

std::vector<RigReadings::Task> RigReadings::list_tasks(const std::vector<double>& values) const {
  std::vector<Task> tasks;
  tasks.reserve(runs_.size() * (1 + 2 * unknowns_.size()));
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    tasks.push_back({&values, r, kNoUnknown, 0.0});
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const Unknown& u = unknowns_[i];
      if (!belongs(u, static_cast<int>(r)) || u.kind == UnknownKind::kBias) continue;
      const auto [upper, lower] = calc_sides(u, values[i], options_.relative_step);
      tasks.push_back({&values, r, i, upper});
      tasks.push_back({&values, r, i, lower});
    }
  }
  return tasks;
}

std::vector<RigReadings::Simulated> RigReadings::simulate(const std::vector<Task>& tasks) {
  std::vector<RigCase> cases;
  cases.reserve(tasks.size());
  for (const Task& task : tasks) {
    std::vector<double> varied = *task.values;
    if (task.unknown != kNoUnknown) varied[task.unknown] = task.value;
    cases.emplace_back(runs_[task.run], static_cast<int>(task.run), unknowns_, varied, options_);
  }
  const std::vector<RigResult> results = simulate_cases(cases, options_.threads);
  simulation_count_ += static_cast<long>(tasks.size());
  std::vector<Simulated> simulated(tasks.size());
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    simulated[k].failure = results[k].failure();
    if (!simulated[k].failure.empty()) continue;
    const std::size_t run = tasks[k].run;
    simulated[k].read.reserve(begin_[run + 1] - begin_[run]);
    for (std::size_t i = begin_[run]; i < begin_[run + 1]; ++i) {
      const ReadingPlace& place = readings_[i];
      simulated[k].read.push_back(results[k].read(
          place.time, static_cast<std::size_t>(runs_[run].channels[place.channel].channel)));
    }
  }
  return simulated;
}

/// Residuals of a run, biases included.
void RigReadings::fill_residual(std::size_t run, const std::vector<double>& values,
                                const std::vector<double>& read, Eigen::VectorXd& residual) const {
  std::vector<double> bias(runs_[run].channels.size(), 0.0);
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (unknowns_[u].kind != UnknownKind::kBias) continue;
    if (!belongs(unknowns_[u], static_cast<int>(run))) continue;
    for (std::size_t c = 0; c < bias.size(); ++c) {
      if (runs_[run].channels[c].channel == unknowns_[u].channel) bias[c] += values[u];
    }
  }
  for (std::size_t i = begin_[run]; i < begin_[run + 1]; ++i) {
    const MeasuredChannel& c = runs_[run].channels[readings_[i].channel];
    const double simulated = read[i - begin_[run]] + bias[readings_[i].channel];
    residual(static_cast<Eigen::Index>(i)) = (simulated - c.values[readings_[i].time]) / c.sigma;
  }
}

void RigReadings::fill_bias_columns(Linearization& out) const {
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (unknowns_[u].kind != UnknownKind::kBias) continue;
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const ReadingPlace& place = readings_[i];
      const MeasuredChannel& c = runs_[place.run].channels[place.channel];
      if (c.channel != unknowns_[u].channel) continue;
      if (!belongs(unknowns_[u], static_cast<int>(place.run))) continue;
      out.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u)) =
          unknowns_[u].scale / c.sigma;
    }
  }
}

Linearization RigReadings::linearize(const std::vector<double>& values) {
  const std::vector<Task> tasks = list_tasks(values);
  const std::vector<Simulated> simulated = simulate(tasks);
  Linearization out;
  for (const Simulated& one : simulated) {
    if (out.failure.empty()) out.failure = one.failure;
  }
  if (!out.failure.empty()) return out;
  const auto rows = static_cast<Eigen::Index>(reading_count() + prior_count_);
  out.residual = Eigen::VectorXd::Zero(rows);
  out.jacobian = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(unknowns_.size()));
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const Task& task = tasks[k];
    if (task.unknown == kNoUnknown) {
      fill_residual(task.run, values, simulated[k].read, out.residual);
      continue;
    }
    const double width = task.value - tasks[k + 1].value;
    for (std::size_t i = begin_[task.run]; i < begin_[task.run + 1]; ++i) {
      const MeasuredChannel& c = runs_[task.run].channels[readings_[i].channel];
      const std::size_t at = i - begin_[task.run];
      const double rise = simulated[k].read[at] - simulated[k + 1].read[at];
      out.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(task.unknown)) =
          rise / width * unknowns_[task.unknown].scale / c.sigma;
    }
    ++k;  // its lower side
  }
  fill_bias_columns(out);
  fill_priors(values, out);
  return out;
}

std::vector<Evaluation> RigReadings::evaluate(const std::vector<std::vector<double>>& points) {
  std::vector<Task> tasks;  // run by run, since those of one may share lanes
  tasks.reserve(points.size() * runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    for (const auto& point : points) tasks.push_back({&point, r, kNoUnknown, 0.0});
  }
  const std::vector<Simulated> simulated = simulate(tasks);
  std::vector<Evaluation> evaluations(points.size());
  const auto rows = static_cast<Eigen::Index>(reading_count() + prior_count_);
  for (std::size_t p = 0; p < points.size(); ++p) {
    Evaluation& e = evaluations[p];
    e.residual = Eigen::VectorXd::Zero(rows);
    for (std::size_t r = 0; r < runs_.size() && e.failure.empty(); ++r) {
      const Simulated& one = simulated[r * points.size() + p];
      e.failure = one.failure;
      if (e.failure.empty()) fill_residual(r, points[p], one.read, e.residual);
    }
    fill_prior_residuals(points[p], e.residual);
  }
  return evaluations;
}

Unknown make_rig_unknown(const std::vector<RigRun>& runs, const std::string& name) {
  const RigRun& run = runs.at(0);
  for (const RigParameter& info : list_rig_settings(run.setup.kind)) {
    if (info.name == name) return make_rig_parameter(run, info);
  }
  const std::vector<RigInputInfo>& inputs = list_rig_inputs(run.setup.kind);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i].name + kGain == name) return make_gain(name, static_cast<int>(i));
  }
  for (const MeasuredChannel& c : run.channels) {
    Unknown u = make_rig_bias(run, kEveryRun, c);
    if (u.name == name) return u;
  }
  std::vector<std::string> names = list_unknown_names(run);
  const std::string allowed = join_names(names);
  for (const RigParameter& info : list_rig_settings(run.setup.kind)) names.push_back(info.name);
  throw InputError("'" + name + "' cannot be free; allowed: " + allowed +
                   ", and parameters of effects" + suggest_name(name, names));
}

std::vector<Unknown> make_initial_states(const std::vector<RigRun>& runs) {
  std::vector<Unknown> unknowns;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const RigRun& run = runs[r];
    const int count = count_coordinates(run.setup.kind);
    if (count == 0) continue;
    const RigCurves curves = simulate_rig_run(run, static_cast<int>(r), {}, {});
    const std::vector<ChannelInfo>& infos = list_rig_channels(run.setup.kind);
    for (int i = 0; i < 2 * count; ++i) {
      const bool rate = i >= count;
      const std::string mass = count == 1 ? "" : i % count == kUnsprung ? "unsprung_" : "sprung_";
      const std::string channel = mass + (rate ? "velocity" : "position");
      const auto found = std::find_if(infos.begin(), infos.end(), [&](const ChannelInfo& info) {
        return info.name == channel;
      });
      Unknown u;
      u.kind = UnknownKind::kInitialState;
      u.name = kInitial + channel;
      u.unit = rate ? "m/s" : "m";
      u.run = static_cast<int>(r);
      u.channel = i % count + (rate ? kRigCoordinates : 0);
      const auto at = static_cast<std::size_t>(found - infos.begin());
      const double spread = curves.failure.empty() ? calc_spread(curves.channel[at]) : 0.0;
      u.start = rate ? 0.0 : read_first_offset(run, channel);
      u.scale = std::max(spread, std::abs(u.start));
      if (u.scale == 0.0) u.scale = 1e-3;  // nothing moves: any small number
      u.prior = {u.start, u.scale};
      u.low = u.start - 100.0 * u.scale;
      u.high = u.start + 100.0 * u.scale;
      unknowns.push_back(std::move(u));
    }
  }
  return unknowns;
}

std::vector<Unknown> make_rig_biases(const std::vector<RigRun>& runs, double wide) {
  std::vector<Unknown> unknowns;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const MeasuredChannel& c : runs[r].channels) {
      unknowns.push_back(make_rig_bias(runs[r], static_cast<int>(r), c));
      unknowns.back().prior = {0.0, wide * unknowns.back().scale};
    }
  }
  return unknowns;
}

}  // namespace strut
