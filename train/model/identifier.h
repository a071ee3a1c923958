// Parameters from one snapshot, by a trained network.
#pragma once

#include <cstddef>
#include <vector>

#include "train/model/model_file.h"
#include "train/network/network.h"

namespace strut {

/// A model laid out for answers at once, in the units of the model's columns. Safe to use from many
/// threads.
class Identifier {
 public:
  explicit Identifier(const TrainedModel& model);

  /// `inputs`: a value for each of model.inputs; `values`: room for each of model.targets.
  /// Allocates nothing. What lies outside of the range trained on is extrapolated: see calc_excess.
  void identify(const double* inputs, double* values) const;

  /// d values / d inputs there, targets x inputs by rows: exact, by forward differentiation through
  /// the layers.
  std::vector<double> calc_jacobian(const double* inputs) const;

 private:
  Predictor predictor_;
  std::vector<double> weights_;
  Normalizer input_map_, target_map_;
};

/// How far x lies beyond [low, high], as a signed share of high - low: negative below, positive
/// above, 0 inside.
double calc_excess(double x, double low, double high);

/// Share of the width of its range by which a parameter may lie beyond it, apart from its interval:
/// cars in new condition stand at the end of a range, and simulations differ by more than a
/// network.
inline constexpr double kParameterMargin = 0.01;

/// False where the whole interval value +- half_width lies beyond the range of target `t` and that
/// margin, or where the value is NaN.
bool is_parameter_in_range(const TrainedModel& model, std::size_t t, double value,
                           double half_width);

}  // namespace strut
