// The readings of one run against its simulations.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "estimate/reading_model.h"
#include "estimate/sampled_curve.h"

namespace strut {

/// Place of an unknown that is not there.
inline constexpr std::size_t kNoUnknown = static_cast<std::size_t>(-1);

/// Steps of the hit times that are tried; a wheel is on the flank of a bump for some ten of them.
inline constexpr double kAlignStep = 1e-3;  // s

bool is_parameter_of(const Unknown& u, std::size_t run);

/// Which unknown is the run's hit time, or kNoUnknown.
std::size_t find_hit_time(const std::vector<Unknown>& unknowns, std::size_t run);

/// Upper and lower side of an unknown, relative_step of its scale away, moved inwards at the
/// bounds.
std::pair<double, double> calc_sides(const Unknown& u, double value, double relative_step);

/// The readings of one run's sensors in a simulation: a series by channel of the run, sample by
/// sample.
using SampledRun = std::vector<std::vector<double>>;

/// Keeps references to what it is made of.
class RunReadings {
 public:
  /// `step`: s between samples of the simulations. `places`: of all runs.
  RunReadings(const std::vector<Unknown>& unknowns, const std::vector<double>& values,
              const MeasuredRun& run, std::size_t run_index, double step,
              const std::vector<ReadingPlace>& places);

  /// Residuals and derivatives; `results` begins with this run's base, then the upper and the lower
  /// side of each of its parameters. Returns how many simulations were this run's.
  std::size_t fill(const SampledRun* results, double relative_step, Linearization& out) const;

  /// Residuals alone, at the values given here instead of those of the constructor.
  void fill_residual(const SampledRun& base, const std::vector<double>& values,
                     Eigen::VectorXd& residual) const;

  /// The hit time within its bounds at which `base`, shifted in time and with the best bias of each
  /// channel, comes nearest to the readings. A search that starts a flank of the bump away from the
  /// truth can end in another valley; trying all costs no simulation. The run has a hit time.
  double find_best_hit_time(const SampledRun& base) const;

 private:
  /// The prior of a channel's bias: mean and 1 / variance, both in sigmas of its noise;
  /// infinitely much where it is no unknown.
  struct Bias {
    double mean, information;
  };

  Bias get_bias(const MeasuredChannel& channel) const;
  CurvePoint read(const SampledRun& simulated, const ReadingPlace& place, double hit_time) const;
  double calc_chi2(const SampledRun& base, double hit_time) const;
  void fill_base_columns(const SampledRun& base, Linearization& out) const;
  void fill_parameter(const SampledRun* results, std::size_t upper, double width, bool centered,
                      std::size_t unknown, Linearization& out) const;

  const std::vector<Unknown>& unknowns_;
  const std::vector<double>& values_;
  const MeasuredRun& run_;
  std::size_t index_;
  double step_, hit_time_ = 0.0;
  std::vector<std::size_t> rows_;  // of this run's readings
  const std::vector<ReadingPlace>& places_;
};

}  // namespace strut
