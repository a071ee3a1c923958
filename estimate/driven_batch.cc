#include "estimate/driven_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/check.h"
#include "base/error/input_error.h"
#include "base/parallel/team.h"
#include "base/text/format_number.h"
#include "estimate/sampled_curve.h"
#include "model/error/model_error.h"
#include "model/kernel/simulation.h"
#include "model/longest_step.h"
#include "model/rig/rig_system.h"
#include "model/sensor/sensors.h"
#include "model_files/read_rig.h"

namespace strut {
namespace {

bool may_share_lanes(const DrivenTask& a, const DrivenTask& b) {
  return a.failure.empty() && b.failure.empty() && a.run == b.run &&
         a.variant.gain == b.variant.gain && a.sampling.step == b.sampling.step;
}

/// The run's inputs times their gains.
std::vector<InputSignal> scale_inputs(const DrivenTask& task) {
  std::vector<InputSignal> scaled = task.run->setup.rig().inputs;
  for (InputSignal& signal : scaled) {
    const int input = find_input(task.run->setup.info(), signal.channel);
    scale_signal(signal, task.variant.gain[static_cast<std::size_t>(input)]);
  }
  return scaled;
}

using Take = std::function<void(std::size_t, const DrivenResult&)>;

/// Simulates tasks [first, end), which may share lanes, together. A single task takes a lane, too,
/// so that its result has the same bits.
void simulate_together(const std::vector<DrivenTask>& tasks, std::size_t first, std::size_t end,
                       const Take& take) {
  const DrivenTask& common = tasks[first];
  StepOptions step;
  step.step = common.sampling.step;
  SamplePlan plan;
  plan.interval = common.sampling.interval;
  plan.duration =
      common.run->times.back() +
      (common.sampling.even ? 0.0 : static_cast<double>(kCurveSamples) * common.sampling.interval);
  plan.snapshot = false;
  std::vector<const RigSpec*> specs;
  specs.reserve(end - first);
  for (std::size_t i = first; i < end; ++i) specs.push_back(&tasks[i].variant.rig);
  try {
    const LaneResults lanes = list_kernels().front().run_rigs(
        specs.data(), static_cast<int>(specs.size()), scale_inputs(common), step, plan);
    for (std::size_t i = first; i < end; ++i) {
      take(i, DrivenResult(tasks[i], lanes, static_cast<int>(i - first)));
    }
  } catch (const ModelError& e) {
    if (end - first == 1) {
      take(first, DrivenResult(fmt::format("{}: {}", common.run->name, e.what())));
      return;
    }
    for (std::size_t i = first; i < end; ++i) simulate_together(tasks, i, i + 1, take);
  }
}

}  // namespace

DrivenVariant make_variant(const MeasuredRun& run, std::size_t index,
                           const std::vector<Unknown>& unknowns,
                           const std::vector<double>& values) {
  DrivenVariant variant{run.setup.rig().rig, {}};
  variant.gain.fill(1.0);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (!belongs(u, index)) continue;
    if (u.kind == UnknownKind::kParameter) set_rig_parameter(variant.rig, u.name, values[i]);
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(variant.rig.force_maps, *u.part, values[i]);
    }
    if (u.kind == UnknownKind::kInputGain) {
      variant.gain[static_cast<std::size_t>(u.input)] *= values[i];
    }
    if (u.kind == UnknownKind::kInitialState) {
      set_initial_state(variant.rig, u.state, values[i]);
    }
  }
  return variant;
}

DrivenSampling choose_sampling(const MeasuredRun& run, const LinearizeOptions& options) {
  const double n = static_cast<double>(run.times.size() - 1);
  const double mean = run.times.back() / n;
  const double longest = std::min(options.longest_step, calc_longest_step(run.setup.rig().rig));
  DrivenSampling s;
  s.even = true;
  for (std::size_t i = 0; i < run.times.size() && s.even; ++i) {
    s.even = std::abs(run.times[i] - mean * static_cast<double>(i)) < 1e-6 * mean;
  }
  s.step = mean / std::ceil(mean / longest - 1e-9);
  s.interval = s.even ? mean : s.step;
  return s;
}

DrivenTask::DrivenTask(const MeasuredRun& measured, std::size_t index,
                       const std::vector<Unknown>& unknowns, const std::vector<double>& values,
                       const LinearizeOptions& options)
    : run(&measured), run_index(index) {
  try {
    variant = make_variant(measured, index, unknowns, values);
    sampling = choose_sampling(measured, options);
    sampling.step = shorten_step(sampling.step, calc_longest_step(variant.rig));
  } catch (const InputError& e) {  // out of a parameter's range
    failure = fmt::format("{}: {}", measured.name, e.what());
  }
}

DrivenResult::DrivenResult(const DrivenTask& task, const LaneResults& results, int lane)
    : run_(task.run),
      sampling_(task.sampling),
      channels_(task.run->setup.info().channels.size()),
      count_(static_cast<std::size_t>(results.sample_count)) {
  if (!results.is_done(lane)) {
    failure_ = fmt::format("{}: the simulation ends at t = {} s: the motion is not finite",
                           run_->name, format_rounded(results.get_failure_time(lane)));
    return;
  }
  history_.resize(count_ * channels_);
  for (std::size_t i = 0; i < history_.size(); ++i) {
    history_[i] =
        results.get_sample(static_cast<int>(i / channels_), static_cast<int>(i % channels_), lane);
  }
  read_sensors(task.variant.rig);
}

double DrivenResult::read(std::size_t time, std::size_t channel) const {
  const auto get = [&](std::size_t sample) { return history_[sample * channels_ + channel]; };
  if (sampling_.even) {
    STRUT_CHECK(time < count_, "a sample at every reading");
    return get(time);
  }
  STRUT_CHECK(count_ >= kCurveSamples, "samples to interpolate");
  return interpolate_samples(get, count_, run_->times[time] / sampling_.interval);
}

/// Replaces the channels by the readings of their sensors.
void DrivenResult::read_sensors(const RigSpec& spec) {
  if (spec.effects.empty()) return;
  for (std::size_t c = 0; c < channels_; ++c) {
    std::vector<double> series(count_);
    for (std::size_t i = 0; i < count_; ++i) series[i] = history_[i * channels_ + c];
    series = read_sensor(spec.effects, get_rig_info(spec.kind).channels[c].name, sampling_.interval,
                         std::move(series));
    for (std::size_t i = 0; i < count_; ++i) history_[i * channels_ + c] = series[i];
  }
}

void simulate_tasks(const std::vector<DrivenTask>& tasks, int threads, const Take& take) {
  const auto width = static_cast<std::size_t>(list_kernels().front().lanes);
  std::vector<std::size_t> begin;  // of each batch
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const bool joins = !begin.empty() && i - begin.back() < width &&
                       may_share_lanes(tasks[begin.back()], tasks[i]);
    if (!joins) begin.push_back(i);
  }
  share_items(threads, begin.size(), [&](std::size_t k, int /*thread*/) {
    const std::size_t first = begin[k], end = k + 1 < begin.size() ? begin[k + 1] : tasks.size();
    if (tasks[first].failure.empty()) {
      simulate_together(tasks, first, end, take);
    } else {
      take(first, DrivenResult(tasks[first].failure));
    }
  });
}

}  // namespace strut
