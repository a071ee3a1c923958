#pragma once

#include <vector>

#include "train/model/model_file.h"
#include "train/network/shape.h"

namespace strut {

/// The weights (outputs x inputs, by rows) and biases of one layer.
struct LayerValues {
  std::vector<double> weights, biases;
};

inline LayerValues get_layer_values(const TrainedModel& model, const NetworkLayer& layer) {
  const auto weights = model.weights.begin() + static_cast<std::ptrdiff_t>(layer.weights);
  const auto biases = model.weights.begin() + static_cast<std::ptrdiff_t>(layer.biases);
  return {{weights, biases}, {biases, biases + layer.outputs}};
}

}  // namespace strut
