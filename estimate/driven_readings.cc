#include "estimate/driven_readings.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "estimate/driven_batch.h"

namespace strut {
namespace {

/// Lets both sides of each difference take equal steps, or the difference would include that of the
/// steps.
void match_steps(const std::vector<RunVariant>& variants, std::vector<DrivenTask>& tasks) {
  for (std::size_t k = 0; k + 1 < tasks.size(); ++k) {
    if (variants[k].unknown == kNoUnknown) continue;
    DrivenTask &upper = tasks[k], &lower = tasks[k + 1];
    if (upper.failure.empty() && lower.failure.empty()) {
      upper.sampling.step = lower.sampling.step =
          std::min(upper.sampling.step, lower.sampling.step);
      upper.sampling.fine_step = lower.sampling.fine_step =
          std::min(upper.sampling.fine_step, lower.sampling.fine_step);
    }
    ++k;
  }
}

class DrivenReadings final : public ReadingModel {
 public:
  DrivenReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                 const LinearizeOptions& options);

  Linearization linearize(const std::vector<double>& values) override;
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;

 private:
  struct Simulated {
    std::string failure;           // reason for which there is no simulation
    std::vector<double> readings;  // of the task's run
  };
  DrivenTask make_task(std::size_t run, const std::vector<double>& values) const {
    return {runs_[run], run, unknowns_, values, options_};
  }
  std::vector<Simulated> simulate(const std::vector<DrivenTask>& tasks);
  void fill_column(const RunVariant& upper, const RunVariant& lower, const Simulated& above,
                   const Simulated& below, Linearization& out) const;

  LinearizeOptions options_;
  std::vector<int> recorded_;         // channels that any run compares, ascending
  std::vector<std::size_t> columns_;  // position of each reading's channel among them
};

DrivenReadings::DrivenReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                               const LinearizeOptions& options)
    : ReadingModel(std::move(runs), std::move(unknowns)), options_(options) {
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    add_readings(r, [](double) { return true; });
  }
  finish();
  std::set<int> compared;
  for (const std::vector<int>& channels : this->channels()) {
    compared.insert(channels.begin(), channels.end());
  }
  recorded_.assign(compared.begin(), compared.end());
  columns_.reserve(readings_.size());
  for (const ReadingPlace& place : readings_) {
    const auto found = compared.find(get_channel(place).channel);
    columns_.push_back(static_cast<std::size_t>(std::distance(compared.begin(), found)));
  }
}

std::vector<DrivenReadings::Simulated> DrivenReadings::simulate(
    const std::vector<DrivenTask>& tasks) {
  std::vector<Simulated> simulated(tasks.size());
  simulate_tasks(tasks, recorded_, options_.threads,
                 [&](std::size_t k, const DrivenResult& result) {
                   simulated[k].failure = result.failure();
                   if (!result.failure().empty()) return;
                   const std::size_t run = tasks[k].run_index;
                   simulated[k].readings.reserve(begin_row(run + 1) - begin_row(run));
                   for (std::size_t i = begin_row(run); i < begin_row(run + 1); ++i) {
                     simulated[k].readings.push_back(result.read(readings_[i].time, columns_[i]));
                   }
                 });
  simulation_count_ += static_cast<long>(tasks.size());
  return simulated;
}

void DrivenReadings::fill_column(const RunVariant& upper, const RunVariant& lower,
                                 const Simulated& above, const Simulated& below,
                                 Linearization& out) const {
  const double width = upper.value - lower.value;
  const std::size_t begin = begin_row(upper.run);
  for (std::size_t i = begin; i < begin_row(upper.run + 1); ++i) {
    const double rise = above.readings[i - begin] - below.readings[i - begin];
    out.jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(upper.unknown)) =
        rise / width * unknowns_[upper.unknown].scale / get_channel(readings_[i]).sigma;
  }
}

Linearization DrivenReadings::linearize(const std::vector<double>& values) {
  const std::vector<RunVariant> variants =
      list_variants(unknowns_, runs_.size(), values, options_.relative_step);
  std::vector<DrivenTask> tasks;
  tasks.reserve(variants.size());
  for (const RunVariant& v : variants) tasks.push_back(make_task(v.run, set_variant(values, v)));
  match_steps(variants, tasks);
  const std::vector<Simulated> simulated = simulate(tasks);
  const auto failed = std::find_if(simulated.begin(), simulated.end(),
                                   [](const Simulated& s) { return !s.failure.empty(); });
  Linearization out = make_linearization(failed == simulated.end() ? "" : failed->failure);
  if (!out.failure.empty()) return out;
  for (std::size_t k = 0; k < variants.size(); ++k) {
    if (variants[k].unknown == kNoUnknown) {
      fill_residual(variants[k].run, values, simulated[k].readings, out.residual);
      fill_sensor_columns(variants[k].run, simulated[k].readings, out);
    } else {
      fill_column(variants[k], variants[k + 1], simulated[k], simulated[k + 1], out);
      ++k;  // the lower side
    }
  }
  fill_priors(values, out);
  return out;
}

std::vector<Evaluation> DrivenReadings::evaluate(const std::vector<std::vector<double>>& points) {
  std::vector<DrivenTask> tasks;  // run by run: those of one run may share lanes
  tasks.reserve(points.size() * runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    for (const auto& point : points) tasks.push_back(make_task(r, point));
  }
  const std::vector<Simulated> simulated = simulate(tasks);
  std::vector<Evaluation> evaluations(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    Evaluation& e = evaluations[p];
    e.residual = Eigen::VectorXd::Zero(row_count());
    for (std::size_t r = 0; r < runs_.size() && e.failure.empty(); ++r) {
      const Simulated& one = simulated[r * points.size() + p];
      e.failure = one.failure;
      if (e.failure.empty()) fill_residual(r, points[p], one.readings, e.residual);
    }
    fill_prior_residuals(points[p], e.residual);
  }
  return evaluations;
}

}  // namespace

std::unique_ptr<ReadingModel> make_driven_readings(std::vector<MeasuredRun> runs,
                                                   std::vector<Unknown> unknowns,
                                                   const LinearizeOptions& options) {
  return std::make_unique<DrivenReadings>(std::move(runs), std::move(unknowns), options);
}

}  // namespace strut
