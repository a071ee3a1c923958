// A rig's runs, driven by what was measured, against their simulation.
//
//   residual = (y_sim(t; p, x0) + b - y_measured) / sigma
//
// p: the rig's parameters and gains of its inputs, x0: where the run starts, b: a sensor's bias.
// Inputs and readings share a clock.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/simulate_rigs.h"
#include "estimate/reading_model.h"

namespace strut {

/// The samples of an input as a signal: a spline, or local cubics of `half_width` [s] > 0. Throws
/// std::invalid_argument as make_signal does.
InputSignal make_sampled_input(const std::string& channel, const std::vector<double>& times,
                               const std::vector<double>& values, double half_width);

/// What a rig does during a run: all its channels at the run's times.
struct RigCurves {
  std::string failure;                       // empty: it got through
  std::vector<std::vector<double>> channel;  // [channel][time]; NaN where time is not simulated
};

/// The value of a parameter by its name. Throws InputError with the nearest known.
double get_rig_parameter(const RigSpec& spec, const std::string& name);

/// `values` of `unknowns`, as far as they belong to run number `index`.
RigCurves simulate_rig_run(const RigRun& run, int index, const std::vector<Unknown>& unknowns,
                           const std::vector<double>& values, const RigOptions& options = {});

/// The run with the unknowns' values in its setup and inputs; biases are left out.
RigRun set_rig_unknowns(const RigRun& run, const std::vector<Unknown>& unknowns,
                        const std::vector<double>& values);

class RigReadings : public ReadingModel {
 public:
  /// Throws InputError for unknowns that are not the rig's.
  RigReadings(std::vector<RigRun> runs, std::vector<Unknown> unknowns,
              const RigOptions& options = {});

  Linearization linearize(const std::vector<double>& values) override;
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;

  const std::vector<RigRun>& runs() const { return runs_; }

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

  std::vector<RigRun> runs_;
  RigOptions options_;
  std::vector<std::size_t> begin_;  // first of each run's readings, and the end
};

/// A rig's parameter or that of an effect, of all runs, within what is allowed; or NAME_gain of an
/// input that some run has; or NAME_bias of a channel. Throws InputError with the nearest known
/// name.
Unknown make_rig_unknown(const std::vector<RigRun>& runs, const std::string& name);

/// The start of every run: offsets from rest and velocities of its masses, with priors as wide as
/// the simulated motion itself; they begin where the first readings are.
std::vector<Unknown> make_initial_states(const std::vector<RigRun>& runs);

/// A bias of every channel of every run that does not read zero at rest by definition; `wide` times
/// the channel's own spread is its prior's sigma.
std::vector<Unknown> make_rig_biases(const std::vector<RigRun>& runs, double wide = 1.0);

}  // namespace strut
