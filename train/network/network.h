// A feedforward network, tansig in the hidden layers and linear at the output: start weights and
// predictions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "train/network/shape.h"

namespace strut {

struct TrainKernel;

/// Range [low, high] of the inputs' values, common to all inputs.
struct InputRange {
  double low = -1.0, high = 1.0;
};

/// Start weights after D. Nguyen and B. Widrow (IJCNN 1990, 3:21-26), as MATLAB documents for
/// initnw with tansig: in a hidden layer of s neurons and r inputs the rows of W point in random
/// directions with length 2 * 0.7 s^(1/r), and b is spread evenly over plus and minus that length,
/// with the sign of the row's first weight (0 for a single neuron); inputs of the first layer are
/// mapped from `range` to [-1, 1]. The output layer, which has no finite active range, is uniform
/// on [-1, 1]. Throws InputError unless range.low < range.high.
std::vector<double> make_nguyen_widrow_weights(const NetworkShape& shape, const InputRange& range,
                                               std::uint64_t seed);

/// Start weights after X. Glorot and Y. Bengio (AISTATS 2010): W uniform within
/// sqrt(6 / (inputs + outputs)), b = 0.
std::vector<double> make_xavier_weights(const NetworkShape& shape, std::uint64_t seed);

/// A trained network with its weights arranged for fast predictions. Thread-safe.
class Predictor {
 public:
  /// Throws InputError unless `weights` are finite and shape.weight_count in number.
  Predictor(const NetworkShape& shape, const std::vector<double>& weights);
  Predictor(const NetworkShape& shape, const std::vector<double>& weights,
            const TrainKernel& kernel);

  const NetworkShape& shape() const { return shape_; }

  /// Predicts one sample; allocates nothing.
  void predict(const double* inputs, double* outputs) const;
  /// Predicts `count` samples: inputs count x shape.inputs(), outputs count x shape.outputs(), by
  /// rows.
  void predict_rows(const double* inputs, std::size_t count, double* outputs) const;

 private:
  NetworkShape shape_;
  const TrainKernel* kernel_;
  std::vector<double> weights_;
  std::vector<double> packed_;  // per layer: b, then the columns of W, each padded to kPadding
};

}  // namespace strut
