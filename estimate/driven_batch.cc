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
         a.variant.inputs == b.variant.inputs && a.sampling.step == b.sampling.step &&
         a.sampling.fine_step == b.sampling.fine_step;
}

/// The run's inputs with their corrections.
std::vector<InputSignal> correct_inputs(const DrivenTask& task) {
  std::vector<InputSignal> corrected = task.run->setup.rig().inputs;
  for (InputSignal& signal : corrected) {
    const int input = find_input(task.run->setup.info(), signal.channel);
    correct_signal(signal, task.variant.inputs[static_cast<std::size_t>(input)]);
  }
  return corrected;
}

using Take = std::function<void(std::size_t, const DrivenResult&)>;

/// Simulates tasks [first, end), which may share lanes, together. A single task takes a lane, too,
/// so that its result has the same bits.
void simulate_together(const std::vector<DrivenTask>& tasks, std::size_t first, std::size_t end,
                       const std::vector<int>& channels, const Take& take) {
  const DrivenTask& common = tasks[first];
  StepOptions step;
  step.step = common.sampling.fine_step;
  if (step.step < common.sampling.step) step.coarse_step = common.sampling.step;
  SamplePlan plan;
  plan.interval = common.sampling.interval;
  plan.duration =
      common.run->times.back() +
      (common.sampling.even ? 0.0 : static_cast<double>(kCurveSamples) * common.sampling.interval);
  plan.snapshot = false;
  plan.recorded = channels;
  std::vector<const RigSpec*> specs;
  specs.reserve(end - first);
  for (std::size_t i = first; i < end; ++i) specs.push_back(&tasks[i].variant.rig);
  try {
    const LaneResults lanes = list_kernels().front().run_rigs(
        specs.data(), static_cast<int>(specs.size()), correct_inputs(common), step, plan);
    for (std::size_t i = first; i < end; ++i) {
      take(i, DrivenResult(tasks[i], lanes, static_cast<int>(i - first)));
    }
  } catch (const ModelError& e) {
    if (end - first == 1) {
      take(first, DrivenResult(fmt::format("{}: {}", common.run->name, e.what())));
      return;
    }
    for (std::size_t i = first; i < end; ++i) simulate_together(tasks, i, i + 1, channels, take);
  }
}

}  // namespace

DrivenVariant make_variant(const MeasuredRun& run, std::size_t index,
                           const std::vector<Unknown>& unknowns,
                           const std::vector<double>& values) {
  DrivenVariant variant{run.setup.rig().rig,
                        list_corrections(unknowns, values, static_cast<int>(index))};
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Unknown& u = unknowns[i];
    if (!belongs(u, index)) continue;
    if (u.kind == UnknownKind::kParameter) set_rig_parameter(variant.rig, u.name, values[i]);
    if (u.kind == UnknownKind::kForceMap) {
      add_map_part(variant.rig.force_maps, *u.part, values[i]);
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
  const double longest =
      std::min(options.longest_step, calc_longest_settled_step(run.setup.rig().rig));
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
    sampling.step = shorten_step(sampling.step, calc_longest_settled_step(variant.rig));
    sampling.fine_step = shorten_step(sampling.step, calc_longest_step(variant.rig));
  } catch (const InputError& e) {  // out of a parameter's range
    failure = fmt::format("{}: {}", measured.name, e.what());
  }
}

DrivenResult::DrivenResult(const DrivenTask& task, const LaneResults& results, int lane)
    : run_(task.run), sampling_(task.sampling) {
  if (!results.is_done(lane)) {
    failure_ = fmt::format("{}: the simulation ends at t = {} s: the motion is not finite",
                           run_->name, format_rounded(results.get_failure_time(lane)));
    return;
  }
  const RigSpec& rig = task.variant.rig;
  for (std::size_t i = 0; i < results.recorded.size(); ++i) {
    const auto channel = static_cast<std::size_t>(results.recorded[i]);
    history_.push_back(read_sensor(rig.effects, get_rig_info(rig.kind).channels[channel],
                                   sampling_.interval,
                                   results.get_history(static_cast<int>(i), lane)));
  }
}

double DrivenResult::read(std::size_t time, std::size_t column) const {
  const std::vector<double>& series = history_[column];
  if (sampling_.even) {
    STRUT_CHECK(time < series.size(), "a sample at every reading");
    return series[time];
  }
  STRUT_CHECK(series.size() >= kCurveSamples, "samples to interpolate");
  const auto get = [&](std::size_t sample) { return series[sample]; };
  return interpolate_samples(get, series.size(), run_->times[time] / sampling_.interval);
}

void simulate_tasks(const std::vector<DrivenTask>& tasks, const std::vector<int>& channels,
                    int threads, const Take& take) {
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
      simulate_together(tasks, first, end, channels, take);
    } else {
      take(first, DrivenResult(tasks[first].failure));
    }
  });
}

}  // namespace strut
