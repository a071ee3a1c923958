#include "train/network/shape.h"

#include <fmt/format.h>

#include <utility>

#include "base/error/input_error.h"

namespace strut {

NetworkShape::NetworkShape(std::vector<int> layer_sizes) : sizes(std::move(layer_sizes)) {
  if (sizes.size() < 2) throw InputError("network: needs at least inputs and outputs");
  for (const int size : sizes) {
    if (size < 1 || size > kLargestSize) {
      throw InputError(
          fmt::format("network: a layer of {} neurons; allowed: 1 to {}", size, +kLargestSize));
    }
  }
  for (std::size_t l = 0; l + 1 < sizes.size(); ++l) {
    NetworkLayer layer;
    layer.inputs = sizes[l];
    layer.outputs = sizes[l + 1];
    const auto in = static_cast<std::size_t>(layer.inputs);
    const auto out = static_cast<std::size_t>(layer.outputs);
    layer.weights = weight_count;
    layer.biases = weight_count + in * out;
    weight_count += (in + 1) * out;
    layer.input_row = activation_rows;
    activation_rows += in + 1;
    layer.output_row = activation_rows;
    layer.delta_row = delta_rows;
    if (l + 2 < sizes.size()) delta_rows += out;
    layers.push_back(layer);  // NOLINT(performance-inefficient-vector-operation): a handful
  }
  activation_rows += static_cast<std::size_t>(sizes.back()) + 1;
}

}  // namespace strut
