// The layers of a feedforward network as numbers: sizes and offsets into its arrays.
//
// All weights are in one vector: per layer W (outputs x inputs, by rows), then b.
#pragma once

#include <cstddef>
#include <vector>

namespace strut {

/// One layer: a = f(W x + b). Offsets are into the weight vector; rows are those of a block's
/// working arrays, which hold samples side by side (train/network/kernel.h).
struct NetworkLayer {
  int inputs = 0, outputs = 0;
  std::size_t weights = 0;     // offset of W
  std::size_t biases = 0;      // offset of b
  std::size_t input_row = 0;   // first row of x; after x a row of ones, for the bias
  std::size_t output_row = 0;  // first row of a
  std::size_t delta_row = 0;   // hidden layers: first row of the derivatives of one output

  /// Offset of the weight from `input` to `output`; input == inputs is the bias.
  std::size_t at(int output, int input) const {
    const auto o = static_cast<std::size_t>(output), i = static_cast<std::size_t>(input);
    return input == inputs ? biases + o : weights + o * static_cast<std::size_t>(inputs) + i;
  }
};

struct NetworkShape {
  /// Maximum number of neurons in a layer.
  static constexpr int kLargestSize = 512;

  /// `layer_sizes`: inputs, any number of hidden layers (also zero), outputs. Throws InputError
  /// unless there are at least two, each from 1 to kLargestSize.
  explicit NetworkShape(std::vector<int> layer_sizes);

  int inputs() const { return sizes.front(); }
  int outputs() const { return sizes.back(); }

  std::vector<int> sizes;
  std::vector<NetworkLayer> layers;
  std::size_t weight_count = 0;
  std::size_t activation_rows = 0;  // all layers, each with its row of ones
  std::size_t delta_rows = 0;       // hidden neurons
};

}  // namespace strut
