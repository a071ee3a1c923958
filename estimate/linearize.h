// The simulated readings of cars that cross a road, and how they react to every unknown.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/linearize_options.h"
#include "estimate/reading_model.h"
#include "estimate/run_prepared.h"
#include "estimate/run_readings.h"
#include "model_files/parameters.h"

namespace strut {

/// Simulates the runs at given values of the unknowns: the base and the +h and -h of every
/// parameter together in lockstep lanes. Simulated time is measured time plus hit time; readings
/// which for a hit time within its bounds would lie outside of the simulation are left aside.
class ReadingSimulator : public ReadingModel {
 public:
  /// Keeps references to neither. Throws InputError for unusable runs or unknowns.
  ReadingSimulator(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns,
                   const LinearizeOptions& options);

  /// `values` in the unknowns' own units. Deterministic.
  Linearization linearize(const std::vector<double>& values) override;

  /// Points whose cars differ in nothing but their sensors share a simulation.
  using ReadingModel::evaluate;
  std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) override;

  /// `values` with the hit time of each run where its readings fit best (run_readings.h); as they
  /// are where they cannot be simulated. One simulation a run.
  std::vector<double> align(const std::vector<double>& values) override;

  const std::vector<MeasuredRun>& runs() const { return runs_; }

 private:
  void choose_readings(std::size_t run);
  void align_durations();
  /// The car and maneuver of a run at these values; throws what the parameters throw.
  Case make_setup(std::size_t run, const std::vector<double>& values) const;
  struct RunSetup {
    std::size_t run;
    Case setup;
  };
  /// Simulates setups in lanes and takes the measured channels, before their sensors; or the
  /// reason of each that fails.
  void sample(const std::vector<RunSetup>& setups, std::vector<SampledRun>& sampled,
              std::vector<std::string>& failures);
  std::string sample_variants(const std::vector<double>& values, const std::vector<Unknown>& varied,
                              std::vector<SampledRun>& sampled);

  std::vector<MeasuredRun> runs_;
  LinearizeOptions options_;
  std::vector<const ParameterInfo*> parameters_;  // by unknown; null where it is none
  std::vector<CasePreparer> preparers_;           // one a run, at the base point's mechanism
};

}  // namespace strut
