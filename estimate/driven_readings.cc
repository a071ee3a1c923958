#include "estimate/driven_readings.h"

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "estimate/run_readings.h"
#include "estimate/sampled_curve.h"

namespace strut {

DrivenReadings::DrivenReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                               const LinearizeOptions& options)
    : ReadingModel(std::move(unknowns)), runs_(std::move(runs)), options_(options) {
  if (runs_.empty()) throw InputError("fit: no measurement");
  check_unknowns(unknowns_, runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const MeasuredRun& run = runs_[r];
    check_measured_run(run);
    channels_.emplace_back();
    for (const MeasuredChannel& c : run.channels) channels_[r].push_back(c.channel);
    begin_.push_back(readings_.size());
    const DrivenSampling sampling = choose_sampling(run, options_);
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

std::vector<DrivenReadings::Task> DrivenReadings::list_tasks(
    const std::vector<double>& values) const {
  std::vector<Task> tasks;
  tasks.reserve(runs_.size() * (1 + 2 * unknowns_.size()));
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    tasks.push_back({&values, r, kNoUnknown, 0.0});
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const Unknown& u = unknowns_[i];
      if (!belongs(u, r) || u.kind == UnknownKind::kBias) continue;
      const auto [upper, lower] = calc_sides(u, values[i], options_.relative_step);
      tasks.push_back({&values, r, i, upper});
      tasks.push_back({&values, r, i, lower});
    }
  }
  return tasks;
}

std::vector<DrivenReadings::Simulated> DrivenReadings::simulate(const std::vector<Task>& tasks) {
  std::vector<DrivenTask> simulations;
  simulations.reserve(tasks.size());
  for (const Task& task : tasks) {
    std::vector<double> varied = *task.values;
    if (task.unknown != kNoUnknown) varied[task.unknown] = task.value;
    simulations.emplace_back(runs_[task.run], task.run, unknowns_, varied, options_);
  }
  // Both sides of a difference go in the same steps, or it would be one of steps, too.
  for (std::size_t k = 0; k + 1 < tasks.size(); ++k) {
    if (tasks[k].unknown == kNoUnknown) continue;
    DrivenTask &upper = simulations[k], &lower = simulations[k + 1];
    if (upper.failure.empty() && lower.failure.empty()) {
      upper.sampling.step = lower.sampling.step =
          std::min(upper.sampling.step, lower.sampling.step);
    }
    ++k;
  }
  std::vector<Simulated> simulated(tasks.size());
  simulate_tasks(simulations, options_.threads, [&](std::size_t k, const DrivenResult& result) {
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
void DrivenReadings::fill_residual(std::size_t run, const std::vector<double>& values,
                                   const std::vector<double>& read,
                                   Eigen::VectorXd& residual) const {
  std::vector<double> bias(runs_[run].channels.size(), 0.0);
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (unknowns_[u].kind != UnknownKind::kBias) continue;
    if (!belongs(unknowns_[u], run)) continue;
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

void DrivenReadings::fill_bias_columns(Linearization& out) const {
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (unknowns_[u].kind != UnknownKind::kBias) continue;
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      const ReadingPlace& place = readings_[i];
      const MeasuredChannel& c = runs_[place.run].channels[place.channel];
      if (c.channel != unknowns_[u].channel) continue;
      if (!belongs(unknowns_[u], place.run)) continue;
      out.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u)) =
          unknowns_[u].scale / c.sigma;
    }
  }
}

Linearization DrivenReadings::linearize(const std::vector<double>& values) {
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

std::vector<Evaluation> DrivenReadings::evaluate(const std::vector<std::vector<double>>& points) {
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

}  // namespace strut
