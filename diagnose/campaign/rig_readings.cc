#include "diagnose/campaign/rig_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "diagnose/campaign/local_cubic.h"
#include "diagnose/campaign/spread.h"
#include "estimate/run_readings.h"
#include "estimate/sampled_curve.h"
#include "model/rig/rig_system.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

constexpr char kGain[] = "_gain", kBias[] = "_bias", kInitial[] = "initial_";

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

double get_rig_parameter(const RigSpec& spec, const std::string& name) {
  return find_rig_parameter(spec.kind, name).get(spec);
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
  RigCurves curves;
  simulate_cases({only}, 1, [&](std::size_t, const RigResult& result) {
    curves.failure = result.failure();
    if (!curves.failure.empty()) return;
    const std::size_t count = list_rig_channels(run.setup.kind).size();
    curves.channel.assign(count, std::vector<double>(run.times.size()));
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t t = 0; t < run.times.size(); ++t) curves.channel[c][t] = result.read(t, c);
    }
  });
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
    const RigSampling sampling = choose_sampling(run, options_);
    const double margin = static_cast<double>(kCurveMargin) * sampling.interval;
    for (std::size_t t = 0; t < run.times.size(); ++t) {
      const bool inside = sampling.even || run.times[t] >= margin;
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
  // Both sides of a difference go in the same steps, or it would be one of steps, too.
  for (std::size_t k = 0; k + 1 < tasks.size(); ++k) {
    if (tasks[k].unknown == kNoUnknown) continue;
    RigCase &upper = cases[k], &lower = cases[k + 1];
    if (upper.failure.empty() && lower.failure.empty()) {
      upper.sampling.step = lower.sampling.step =
          std::min(upper.sampling.step, lower.sampling.step);
    }
    ++k;
  }
  std::vector<Simulated> simulated(tasks.size());
  simulate_cases(cases, options_.threads, [&](std::size_t k, const RigResult& result) {
    simulated[k].failure = result.failure();
    if (!result.failure().empty()) return;
    const std::size_t run = tasks[k].run;
    simulated[k].read.reserve(begin_[run + 1] - begin_[run]);
    for (std::size_t i = begin_[run]; i < begin_[run + 1]; ++i) {
      const ReadingPlace& place = readings_[i];
      simulated[k].read.push_back(result.read(
          place.time, static_cast<std::size_t>(runs_[run].channels[place.channel].channel)));
    }
  });
  simulation_count_ += static_cast<long>(tasks.size());
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
