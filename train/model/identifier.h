// Identifies parameters from one snapshot by a trained network.
#pragma once

#include <cstddef>
#include <vector>

#include "train/model/model_file.h"
#include "train/network/network.h"

namespace strut {

/// A model arranged for fast predictions, in the units of the model's columns. Thread-safe.
class Identifier {
 public:
  explicit Identifier(const TrainedModel& model);

  /// `inputs`: a value for each of model.inputs; `values`: room for each of model.targets.
  /// Allocates nothing. Extrapolates outside of the training range (see calc_excess).
  void identify(const double* inputs, double* values) const;

  /// d values / d inputs at `inputs`, targets x inputs by rows: exact, by forward differentiation
  /// through the layers.
  std::vector<double> calc_jacobian(const double* inputs) const;

 private:
  Predictor predictor_;
  std::vector<double> weights_;
  Normalizer input_map_, target_map_;
};

/// Signed distance of x from [low, high], as a fraction of high - low: negative below, positive
/// above, 0 inside.
double calc_excess(double x, double low, double high);

/// Distance by which a parameter may lie beyond its training range, in addition to its interval, as
/// a fraction of the range: a car in new condition is at the end of a range, and the error of the
/// simulation exceeds that of the network.
inline constexpr double kParameterMargin = 0.01;

/// That distance and the half width of the interval of target `t`, in its unit.
double calc_parameter_margin(const TrainedModel& model, std::size_t t, double half_width);

/// False if the whole interval value ± half_width lies outside of the range of target `t`, extended
/// by kParameterMargin, or if the value is NaN.
bool is_parameter_in_range(const TrainedModel& model, std::size_t t, double value,
                           double half_width);

}  // namespace strut
