// Runs that recorded inputs drive, against their simulation.
//
//   residual = (y_sim(t; p, x0) + b - y_measured) / sigma
//
// p: parameters and gains of the inputs, x0: where the run starts, b: a sensor's bias. Inputs and
// readings share a clock.
#pragma once

#include <string>
#include <vector>

#include "estimate/driven_batch.h"
#include "estimate/reading_model.h"

namespace strut {

class DrivenReadings : public ReadingModel {
 public:
  /// Throws InputError for unusable runs or unknowns.
  DrivenReadings(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                 const LinearizeOptions& options);

  Linearization linearize(const std::vector<double>& values) override;
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;

 private:
  /// A simulation of a run: its base, or with one unknown beside it.
  struct Task {
    const std::vector<double>* values;
    std::size_t run, unknown;
    double value;
  };
  struct Simulated {
    std::string failure;       // why there is no simulation
    std::vector<double> read;  // by the run's readings
  };
  std::vector<Task> list_tasks(const std::vector<double>& values) const;
  std::vector<Simulated> simulate(const std::vector<Task>& tasks);
  void fill_residual(std::size_t run, const std::vector<double>& values,
                     const std::vector<double>& read, Eigen::VectorXd& residual) const;
  void fill_bias_columns(Linearization& out) const;

  std::vector<MeasuredRun> runs_;
  LinearizeOptions options_;
  std::vector<std::size_t> begin_;  // first of each run's readings, and the end
};

}  // namespace strut
