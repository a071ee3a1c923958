// Reference networks by plain loops, which share only the layout of the weights with the trainer.
#pragma once

#include <cmath>
#include <vector>

#include "base/math/random.h"
#include "train/data/row_source.h"
#include "train/network/shape.h"

namespace strut::test {

/// Zero to five hidden layers, one to five inputs, one to four outputs; sizes that are multiples of
/// the vector width and others.
inline const std::vector<std::vector<int>> kShapes{
    {2, 3},          {1, 1, 1},          {4, 27, 19, 11, 4},    {3, 8, 2},
    {5, 9, 7, 5, 2}, {2, 6, 5, 4, 3, 3}, {4, 7, 6, 5, 4, 3, 1}, {1, 17, 16, 4}};

/// Uniform on [-1, 1).
inline std::vector<double> make_uniform(std::size_t count, int seed) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = 2.0 * calc_uniform(static_cast<std::uint64_t>(seed), 0, i) - 1.0;
  }
  return values;
}

inline std::vector<double> make_random_weights(const NetworkShape& shape, int seed) {
  return make_uniform(shape.weight_count, seed);
}

/// Values of every layer for one sample, inputs first.
inline std::vector<std::vector<double>> calc_layers(const NetworkShape& shape,
                                                    const std::vector<double>& weights,
                                                    const double* inputs) {
  std::vector<std::vector<double>> values{{inputs, inputs + shape.inputs()}};
  values.reserve(shape.layers.size() + 1);
  for (const NetworkLayer& layer : shape.layers) {
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(layer.outputs));
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = weights[layer.at(o, layer.inputs)];
      for (int i = 0; i < layer.inputs; ++i) {
        sum += weights[layer.at(o, i)] * values.back()[static_cast<std::size_t>(i)];
      }
      out.push_back(&layer == &shape.layers.back() ? sum : std::tanh(sum));
    }
    values.push_back(std::move(out));
  }
  return values;
}

inline std::vector<double> calc_outputs(const NetworkShape& shape,
                                        const std::vector<double>& weights, const double* inputs) {
  return calc_layers(shape, weights, inputs).back();
}

/// dy / dw of one sample, outputs x weights, by back-propagation of each output.
inline std::vector<std::vector<double>> calc_jacobian(const NetworkShape& shape,
                                                      const std::vector<double>& weights,
                                                      const double* inputs) {
  const auto values = calc_layers(shape, weights, inputs);
  const auto outputs = static_cast<std::size_t>(shape.outputs());
  std::vector<std::vector<double>> jacobian(outputs, std::vector<double>(shape.weight_count, 0.0));
  for (std::size_t k = 0; k < outputs; ++k) {
    std::vector<double> delta(outputs, 0.0);
    delta[k] = 1.0;
    for (std::size_t l = shape.layers.size(); l-- > 0;) {
      const NetworkLayer& layer = shape.layers[l];
      std::vector<double> before(static_cast<std::size_t>(layer.inputs), 0.0);
      for (int o = 0; o < layer.outputs; ++o) {
        const double d = delta[static_cast<std::size_t>(o)];
        jacobian[k][layer.at(o, layer.inputs)] = d;
        for (int i = 0; i < layer.inputs; ++i) {
          const double a = values[l][static_cast<std::size_t>(i)];
          jacobian[k][layer.at(o, i)] = d * a;
          before[static_cast<std::size_t>(i)] += d * weights[layer.at(o, i)] * (1.0 - a * a);
        }
      }
      delta = before;
    }
  }
  return jacobian;
}

/// Random rows for a shape.
inline MemorySource make_random_rows(const NetworkShape& shape, std::size_t rows, int seed) {
  return {shape.inputs(), make_uniform(rows * static_cast<std::size_t>(shape.inputs()), seed),
          shape.outputs(),
          make_uniform(rows * static_cast<std::size_t>(shape.outputs()), seed + 1)};
}

}  // namespace strut::test
