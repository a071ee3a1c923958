#include "train/model/identifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace strut {
namespace {

/// Values of a layer, and their derivatives by the network's inputs, a row per neuron.
struct Derivatives {
  std::vector<double> values, by_input;
};

/// a = f(W x + b) and da = f'(W x + b) W dx.
Derivatives pass_layer(const NetworkLayer& layer, const double* weights, const Derivatives& x,
                       std::size_t inputs, bool hidden) {
  const auto count = static_cast<std::size_t>(layer.outputs);
  Derivatives a{std::vector<double>(count), std::vector<double>(count * inputs, 0.0)};
  for (int o = 0; o < layer.outputs; ++o) {
    double sum = weights[layer.at(o, layer.inputs)];
    double* row = a.by_input.data() + static_cast<std::size_t>(o) * inputs;
    for (int i = 0; i < layer.inputs; ++i) {
      const double w = weights[layer.at(o, i)];
      const double* from = x.by_input.data() + static_cast<std::size_t>(i) * inputs;
      sum += w * x.values[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < inputs; ++k) row[k] += w * from[k];
    }
    const double value = hidden ? std::tanh(sum) : sum;
    const double slope = hidden ? 1.0 - value * value : 1.0;
    a.values[static_cast<std::size_t>(o)] = value;
    for (std::size_t k = 0; k < inputs; ++k) row[k] *= slope;
  }
  return a;
}

/// Normalized inputs and their derivatives by the inputs as measured.
Derivatives make_inputs(const Normalizer& map, const double* inputs) {
  const std::size_t n = map.columns();
  Derivatives x{std::vector<double>(inputs, inputs + n), std::vector<double>(n * n, 0.0)};
  map.normalize(x.values);
  for (std::size_t i = 0; i < n; ++i) x.by_input[i * n + i] = 2.0 / (map.high()[i] - map.low()[i]);
  return x;
}

}  // namespace

Identifier::Identifier(const TrainedModel& model)
    : predictor_(NetworkShape(model.sizes), model.weights),
      weights_(model.weights),
      input_map_(model.input_map),
      target_map_(model.target_map) {}

void Identifier::identify(const double* inputs, double* values) const {
  std::array<double, NetworkShape::kLargestSize> normalized;
  const std::size_t n = input_map_.columns();
  std::copy_n(inputs, n, normalized.begin());
  input_map_.normalize(std::span(normalized.data(), n));
  predictor_.predict(normalized.data(), values);
  target_map_.restore(std::span(values, target_map_.columns()));
}

std::vector<double> Identifier::calc_jacobian(const double* inputs) const {
  const std::size_t n = input_map_.columns();
  const NetworkShape& shape = predictor_.shape();
  Derivatives x = make_inputs(input_map_, inputs);
  for (const NetworkLayer& layer : shape.layers) {
    x = pass_layer(layer, weights_.data(), x, n, &layer != &shape.layers.back());
  }
  for (std::size_t t = 0; t < target_map_.columns(); ++t) {
    const double scale = 0.5 * (target_map_.high()[t] - target_map_.low()[t]);
    for (std::size_t i = 0; i < n; ++i) x.by_input[t * n + i] *= scale;
  }
  return std::move(x.by_input);
}

double calc_excess(double x, double low, double high) {
  const double width = high - low;
  if (x < low) return (x - low) / width;
  if (x > high) return (x - high) / width;
  return 0.0;
}

double calc_parameter_margin(const TrainedModel& model, std::size_t t, double half_width) {
  return half_width + kParameterMargin * (model.target_map.high()[t] - model.target_map.low()[t]);
}

bool is_parameter_in_range(const TrainedModel& model, std::size_t t, double value,
                           double half_width) {
  const double low = model.target_map.low()[t], high = model.target_map.high()[t];
  const double margin = calc_parameter_margin(model, t, half_width);
  return value + margin >= low && value - margin <= high;
}

}  // namespace strut
