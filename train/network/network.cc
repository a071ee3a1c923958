#include "train/network/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/math/all_finite.h"
#include "base/math/random.h"
#include "train/network/kernel.h"

namespace strut {
namespace {

/// First of the streams of calc_uniform, one per layer.
constexpr std::uint64_t kStartStream = std::uint64_t{1} << 40;

/// Random numbers for the start weights of one layer, in sequence.
class LayerRandom {
 public:
  LayerRandom(std::uint64_t seed, std::size_t layer) : seed_(seed), stream_(kStartStream + layer) {}
  /// Uniform on [-1, 1).
  double draw() { return 2.0 * calc_uniform(seed_, stream_, counter_++) - 1.0; }

 private:
  std::uint64_t seed_, stream_, counter_ = 0;
};

/// Fills rows with random directions: uniform on the cube, scaled to unit length.
void fill_unit_rows(LayerRandom& random, int rows, int columns, double* w) {
  for (int row = 0; row < rows; ++row) {
    double sum = 0.0;
    for (int i = 0; i < columns; ++i) {
      w[i] = random.draw();
      sum += w[i] * w[i];
    }
    for (int i = 0; i < columns; ++i) w[i] /= std::sqrt(sum);
    w += columns;
  }
}

void fill_nguyen_widrow(const NetworkLayer& layer, LayerRandom random, double* weights) {
  constexpr double kHalfActiveRange = 2.0;  // tansig bends most within [-2, 2]
  double* w = weights + layer.weights;
  double* b = weights + layer.biases;
  const double length = kHalfActiveRange * 0.7 * std::pow(layer.outputs, 1.0 / layer.inputs);
  fill_unit_rows(random, layer.outputs, layer.inputs, w);
  for (int o = 0; o < layer.outputs; ++o) {
    const double position = layer.outputs > 1 ? -1.0 + 2.0 * o / (layer.outputs - 1) : 0.0;
    double* row = w + static_cast<std::ptrdiff_t>(o) * layer.inputs;
    b[o] = length * position * (row[0] < 0.0 ? -1.0 : 1.0);
    for (int i = 0; i < layer.inputs; ++i) row[i] *= length;
  }
}

/// Transforms weights for inputs on [-1, 1] to weights for inputs on `range`.
void map_inputs(const NetworkLayer& layer, const InputRange& range, double* weights) {
  const double scale = 2.0 / (range.high - range.low);
  const double shift = -(range.high + range.low) / (range.high - range.low);
  for (int o = 0; o < layer.outputs; ++o) {
    double sum = 0.0;
    for (int i = 0; i < layer.inputs; ++i) {
      double& w = weights[layer.at(o, i)];
      sum += w;
      w *= scale;
    }
    weights[layer.at(o, layer.inputs)] += shift * sum;
  }
}

std::size_t pad(int size) {
  return (static_cast<std::size_t>(size) + kPadding - 1) / kPadding * kPadding;
}

std::vector<double> pack_weights(const NetworkShape& shape, const std::vector<double>& weights) {
  std::vector<double> packed;
  for (const NetworkLayer& layer : shape.layers) {
    const std::size_t width = pad(layer.outputs), start = packed.size();
    packed.resize(start + width * static_cast<std::size_t>(layer.inputs + 1), 0.0);
    for (int o = 0; o < layer.outputs; ++o) {
      double* column = packed.data() + start + o;
      *column = weights[layer.at(o, layer.inputs)];
      for (int i = 0; i < layer.inputs; ++i)
        column[width * (static_cast<std::size_t>(i) + 1)] = weights[layer.at(o, i)];
    }
  }
  return packed;
}

}  // namespace

std::vector<double> make_nguyen_widrow_weights(const NetworkShape& shape, const InputRange& range,
                                               std::uint64_t seed) {
  if (!(range.low < range.high)) {
    throw InputError(fmt::format("network: input range [{:f}, {:f}]: low must be below high",
                                 range.low, range.high));
  }
  std::vector<double> weights(shape.weight_count);
  const std::size_t last = shape.layers.size() - 1;
  for (std::size_t l = 0; l < last; ++l) {
    fill_nguyen_widrow(shape.layers[l], LayerRandom(seed, l), weights.data());
  }
  if (last > 0) map_inputs(shape.layers[0], range, weights.data());
  LayerRandom random(seed, last);
  for (std::size_t i = shape.layers[last].weights; i < weights.size(); ++i) {
    weights[i] = random.draw();
  }
  return weights;
}

std::vector<double> make_xavier_weights(const NetworkShape& shape, std::uint64_t seed) {
  std::vector<double> weights(shape.weight_count, 0.0);
  for (std::size_t l = 0; l < shape.layers.size(); ++l) {
    const NetworkLayer& layer = shape.layers[l];
    const double bound = std::sqrt(6.0 / (layer.inputs + layer.outputs));
    LayerRandom random(seed, l);
    for (std::size_t i = layer.weights; i < layer.biases; ++i) weights[i] = bound * random.draw();
  }
  return weights;
}

Predictor::Predictor(const NetworkShape& shape, const std::vector<double>& weights)
    : Predictor(shape, weights, get_train_kernel()) {}

Predictor::Predictor(const NetworkShape& shape, const std::vector<double>& weights,
                     const TrainKernel& kernel)
    : shape_(shape), kernel_(&kernel), weights_(weights) {
  if (weights.size() != shape.weight_count) {
    throw InputError(
        fmt::format("network: {} weights; this shape has {}", weights.size(), shape.weight_count));
  }
  if (!all_finite(weights)) throw InputError("network: a weight is not finite");
  packed_ = pack_weights(shape_, weights_);
}

void Predictor::predict(const double* inputs, double* outputs) const {
  kernel_->predict(shape_, packed_.data(), inputs, outputs);
}

void Predictor::predict_rows(const double* inputs, std::size_t count, double* outputs) const {
  std::vector<double> activations(shape_.activation_rows * kBlockRows);
  const auto in = static_cast<std::size_t>(shape_.inputs());
  const auto out = static_cast<std::size_t>(shape_.outputs());
  for (std::size_t first = 0; first < count; first += kBlockRows) {
    const std::size_t rows = std::min(count - first, static_cast<std::size_t>(kBlockRows));
    const Block block{activations.data(), kBlockRows};
    load_inputs(shape_, inputs + first * in, rows, block);
    kernel_->run_forward(shape_, weights_.data(), block);
    const double* result = block.activations + shape_.layers.back().output_row * kBlockRows;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t o = 0; o < out; ++o) {
        outputs[(first + row) * out + o] = result[o * kBlockRows + row];
      }
    }
  }
}

}  // namespace strut
