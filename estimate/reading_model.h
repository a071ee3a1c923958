// Readings of one or several runs against their simulation: the model of a fit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/math/eigen_abi.h"
#include "estimate/unknown.h"

namespace strut {

/// Residuals and their derivatives at one point.
struct Linearization {
  std::string failure;  // why a run cannot be simulated here; empty: all can
  /// (y_sim(t + hit_time) + bias - y_measured) / sigma by run, time and channel; then
  /// (value - mean) / sigma of every prior.
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;  // by unknowns, in units of their scale
};

/// Failure and residuals of a Linearization.
struct Evaluation {
  std::string failure;
  Eigen::VectorXd residual;
};

/// Indices of the reading that a residual belongs to.
struct ReadingPlace {
  std::size_t run, time, channel;  // the latter in MeasuredRun::channels
};

inline constexpr std::size_t kNoUnknown = static_cast<std::size_t>(-1);

/// One simulation of a run that a Jacobian needs: its base point, or one unknown beside it.
struct RunVariant {
  std::size_t run = 0;
  std::size_t unknown = kNoUnknown;  // kNoUnknown: the base point
  double value = 0.0;                // of that unknown
};

/// Returns `values` with the variant's unknown at the variant's value.
std::vector<double> set_variant(std::vector<double> values, const RunVariant& variant);

/// Lists by run: the base point, then the upper and the lower side of each unknown that its
/// simulation depends on (calc_sides).
std::vector<RunVariant> list_variants(const std::vector<Unknown>& unknowns, std::size_t run_count,
                                      const std::vector<double>& values, double relative_step);

/// Returns the upper and the lower side of an unknown's central difference: `relative_step` of its
/// scale away from `value`, moved inwards at the bounds.
std::pair<double, double> calc_sides(const Unknown& u, double value, double relative_step);

/// Simulated readings of all runs against the measured ones, as a function of the unknowns.
/// make_readings (readings.h) chooses the implementation: cars on a road or runs that recorded
/// inputs drive.
class ReadingModel {
 public:
  virtual ~ReadingModel() = default;

  /// `values` in the unknowns' own units. Deterministic.
  virtual Linearization linearize(const std::vector<double>& values) = 0;
  /// Residuals at several points, simulated together; a point that fails affects no other.
  virtual std::vector<Evaluation> evaluate(const std::vector<std::vector<double>>& points) = 0;
  /// Residuals at one point.
  Evaluation evaluate(const std::vector<double>& values) {
    return evaluate(std::vector<std::vector<double>>{values}).front();
  }
  /// Derivatives of the readings' residuals by the coefficients of a run's rough tracks
  /// (model/scenario/rough_track.h), left before right [1/m], where the model has a road; handed to
  /// `take` some columns at a time, with the index of the first. Returns why the run cannot be
  /// simulated, "" if it can. May be called for several runs at once.
  using TakeColumns = std::function<void(Eigen::Index first, const Eigen::MatrixXd& columns)>;
  virtual std::string linearize_road(const std::vector<double>& values, std::size_t run,
                                     const TakeColumns& take);
  /// Whether the residuals are independent, so that their squares tell how large the noise is where
  /// an unknown is decided; those of successive samples are not.
  virtual bool has_independent_residuals() const { return false; }
  /// Number of independent readings: the expected sum of squares of their residuals, if the model
  /// is right.
  virtual double calc_independent_count() const { return static_cast<double>(reading_count()); }
  /// Returns `values` with unknowns improved that need no search, such as the hit times.
  virtual std::vector<double> align(const std::vector<double>& values) { return values; }

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// Indices of the first reading_count() residuals, run by run.
  const std::vector<ReadingPlace>& readings() const { return readings_; }
  std::size_t reading_count() const { return readings_.size(); }
  std::size_t prior_count() const { return prior_count_; }
  /// Number of readings left out because they lie outside of the simulated time.
  std::size_t outside_count() const { return outside_count_; }
  /// Number of cases simulated so far.
  long simulation_count() const { return simulation_count_; }
  /// The compared channels by run, as indices in ModelInfo::channels.
  const std::vector<std::vector<int>>& channels() const { return channels_; }

 protected:
  explicit ReadingModel(std::vector<Unknown> unknowns) : unknowns_(std::move(unknowns)) {}
  /// Throws InputError for unusable runs or unknowns.
  ReadingModel(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns);
  ReadingModel(const ReadingModel&) = default;
  ReadingModel& operator=(const ReadingModel&) = default;

  /// Adds the readings of the next run; `is_inside(time)`: whether the simulation covers it.
  template <class IsInside>
  void add_readings(std::size_t run, const IsInside& is_inside);
  /// To be called once all readings are added. Throws InputError where there are fewer readings
  /// than unknowns.
  void finish();

  Eigen::Index row_count() const {
    return static_cast<Eigen::Index>(reading_count() + prior_count_);
  }
  /// First row of a run's readings; for the number of runs, the end of all.
  std::size_t begin_row(std::size_t run) const { return begin_[run]; }
  const MeasuredChannel& get_channel(const ReadingPlace& place) const {
    return runs_[place.run].channels[place.channel];
  }

  /// Makes a linearization of zeros or, with a `failure`, one that failed.
  Linearization make_linearization(std::string failure) const;
  /// Fills in the residuals of a run from its simulated readings, to which it adds the errors of
  /// the sensors.
  void fill_residual(std::size_t run, const std::vector<double>& values,
                     const std::vector<double>& simulated, Eigen::VectorXd& residual) const;
  /// Fills in the columns of the errors of a run's sensors.
  void fill_sensor_columns(std::size_t run, const std::vector<double>& simulated,
                           Linearization& out) const;
  /// Fills in the residuals of the priors, after those of the readings; fill_priors also their
  /// derivatives.
  void fill_prior_residuals(const std::vector<double>& values, Eigen::VectorXd& residual) const;
  void fill_priors(const std::vector<double>& values, Linearization& out) const;

  std::vector<MeasuredRun> runs_;
  std::vector<Unknown> unknowns_;
  std::vector<ReadingPlace> readings_;
  std::vector<std::vector<int>> channels_;
  std::size_t prior_count_ = 0, outside_count_ = 0;
  long simulation_count_ = 0;

 private:
  /// Simulated readings of one channel of a run.
  struct ChannelReadings {
    std::vector<std::size_t> rows;
    std::vector<double> times, values;
  };
  void add_reading_rows(std::size_t run, std::size_t time);
  ChannelReadings collect_channel(std::size_t run, std::size_t channel,
                                  const std::vector<double>& simulated) const;

  std::vector<std::size_t> begin_ = {0};
};

template <class IsInside>
void ReadingModel::add_readings(std::size_t run, const IsInside& is_inside) {
  const std::vector<double>& times = runs_[run].times;
  for (std::size_t t = 0; t < times.size(); ++t) {
    if (is_inside(times[t])) {
      add_reading_rows(run, t);
    } else {
      outside_count_ += runs_[run].channels.size();
    }
  }
  begin_.push_back(readings_.size());
}

/// Rows of the readings of one run, and the unknowns they depend on.
struct RunBlock {
  Eigen::Index begin = 0, count = 0;
  std::vector<Eigen::Index> unknowns;
};
std::vector<RunBlock> list_blocks(const ReadingModel& model);
/// A block's rows of the Jacobian, by the block's unknowns.
Eigen::MatrixXd get_block(const Eigen::MatrixXd& jacobian, const RunBlock& block);

/// J'J and J'r of a linearization. Readings depend only on their own run's unknowns and the shared
/// ones, which saves most of the work.
struct NormalEquations {
  Eigen::MatrixXd information, of_priors;  // the latter: the part of the former from the priors
  Eigen::VectorXd gradient;
};
NormalEquations calc_normal_equations(const ReadingModel& model, const Linearization& at);

}  // namespace strut
