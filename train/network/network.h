// A feedforward network: tansig in the hidden layers, linear at the output.
//
// All weights stand in one vector: per layer W (outputs x inputs, by rows), then b.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace strut {

struct TrainKernel;

/// One layer: a = f(W x + b). Offsets of the weights are into the weight vector; rows are those of
/// a block's working arrays, which hold samples side by side (train/network/kernel.h).
struct NetworkLayer {
  int inputs = 0, outputs = 0;
  std::size_t weights = 0;     // offset of W
  std::size_t biases = 0;      // offset of b
  std::size_t input_row = 0;   // rows of x; after them a row of ones, for the bias
  std::size_t output_row = 0;  // rows of a
  std::size_t delta_row = 0;   // hidden layers: rows of the derivatives of one output

  /// Offset of the weight from `input` to `output`; input == inputs is the bias.
  std::size_t at(int output, int input) const {
    const auto o = static_cast<std::size_t>(output), i = static_cast<std::size_t>(input);
    return input == inputs ? biases + o : weights + o * static_cast<std::size_t>(inputs) + i;
  }
};

struct NetworkShape {
  /// Widest layer.
  static constexpr int kLargestSize = 512;

  /// `layer_sizes`: inputs, hidden layers (any number, none too), outputs. Throws InputError unless
  /// there are two or more, each from 1 to kLargestSize.
  explicit NetworkShape(std::vector<int> layer_sizes);

  int inputs() const { return sizes.front(); }
  int outputs() const { return sizes.back(); }

  std::vector<int> sizes;
  std::vector<NetworkLayer> layers;
  std::size_t weight_count = 0;
  std::size_t activation_rows = 0;  // all layers, each with its row of ones
  std::size_t delta_rows = 0;       // hidden neurons
};

/// Range [low, high] of the values that the inputs take, the same for all of them.
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

/// A trained network, laid out for answers at once. Safe to use from many threads.
class Predictor {
 public:
  /// Throws InputError unless there is one finite weight for each of the shape's.
  Predictor(const NetworkShape& shape, const std::vector<double>& weights);
  Predictor(const NetworkShape& shape, const std::vector<double>& weights,
            const TrainKernel& kernel);

  const NetworkShape& shape() const { return shape_; }

  /// One sample; allocates nothing.
  void predict(const double* inputs, double* outputs) const;
  /// Many: inputs count x shape.inputs() by rows, outputs count x shape.outputs().
  void predict_rows(const double* inputs, std::size_t count, double* outputs) const;

 private:
  NetworkShape shape_;
  const TrainKernel* kernel_;
  std::vector<double> weights_;
  std::vector<double> packed_;  // per layer: b, then the columns of W, each padded to kPadding
};

}  // namespace strut
