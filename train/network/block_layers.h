// Forward and backward passes of a block through the layers. Included only by kernel_isa.cc, which
// is compiled for every instruction set.
#pragma once

#include <xsimd/xsimd.hpp>

#include "train/network/kernel.h"

namespace strut {

using Vector = xsimd::batch<double, xsimd::default_arch>;
inline constexpr std::size_t kWidth = Vector::size;

/// A matrix read with any strides: w(o, i) = data[o * row + i * column].
struct WeightView {
  const double* data;
  std::size_t row, column;
};

/// Computes `kRows` x `kVectors` vectors of out = start + W in: enough sums at once to hide the
/// latency of a multiply-add, few enough for sixteen registers.
template <std::size_t kRows, std::size_t kVectors, bool kAdd>
void multiply_patch(const WeightView& w, std::size_t count, const double* bias, const double* in,
                    std::size_t stride, double* out, std::size_t out_stride) {
  Vector sum[kRows][kVectors];
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      sum[r][v] = kAdd ? Vector::load_unaligned(out + r * out_stride + v * kWidth)
                       : Vector(bias != nullptr ? bias[r] : 0.0);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Vector x[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      x[v] = Vector::load_unaligned(in + i * stride + v * kWidth);
    }
    for (std::size_t r = 0; r < kRows; ++r) {
      const Vector factor(w.data[r * w.row + i * w.column]);
      for (std::size_t v = 0; v < kVectors; ++v) sum[r][v] = xsimd::fma(factor, x[v], sum[r][v]);
    }
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      sum[r][v].store_unaligned(out + r * out_stride + v * kWidth);
    }
  }
}

/// out = bias + W in, or with kAdd out += W in, over a block; W is rows x count.
template <bool kAdd>
void multiply(const WeightView& w, std::size_t rows, std::size_t count, const double* bias,
              const double* in, std::size_t stride, double* out, std::size_t out_stride) {
  constexpr std::size_t kVectors = 2, kPatch = 4;
  const auto run = [&]<std::size_t kRows>(std::size_t row) {
    const WeightView part{w.data + row * w.row, w.row, w.column};
    const double* part_bias = bias != nullptr ? bias + row : nullptr;
    for (std::size_t s = 0; s < kBlockRows; s += kVectors * kWidth) {
      multiply_patch<kRows, kVectors, kAdd>(part, count, part_bias, in + s, stride,
                                            out + row * out_stride + s, out_stride);
    }
  };
  std::size_t row = 0;
  for (; row + kPatch <= rows; row += kPatch) run.template operator()<kPatch>(row);
  for (; row < rows; ++row) run.template operator()<1>(row);
}

/// Calls f(offset of a vector) over `rows` rows of a block.
template <class F>
void for_each_vector(std::size_t rows, std::size_t stride, const F& f) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t s = 0; s < kBlockRows; s += kWidth) f(r * stride + s);
  }
}

inline Vector load(const double* p) { return Vector::load_unaligned(p); }

inline std::size_t count_outputs(const NetworkLayer& layer) {
  return static_cast<std::size_t>(layer.outputs);
}
inline std::size_t count_inputs(const NetworkLayer& layer) {
  return static_cast<std::size_t>(layer.inputs);
}
inline WeightView get_weights(const NetworkLayer& layer, const double* weights) {
  return {weights + layer.weights, count_inputs(layer), 1};
}

inline void run_forward(const NetworkShape& shape, const double* weights, const Block& block) {
  for (const NetworkLayer& layer : shape.layers) {
    double* out = block.activations + layer.output_row * block.stride;
    multiply<false>(get_weights(layer, weights), count_outputs(layer), count_inputs(layer),
                    weights + layer.biases, block.activations + layer.input_row * block.stride,
                    block.stride, out, block.stride);
    if (&layer == &shape.layers.back()) break;
    for_each_vector(count_outputs(layer), block.stride,
                    [&](std::size_t at) { xsimd::tanh(load(out + at)).store_unaligned(out + at); });
  }
}

/// Computes delta of a hidden layer from that of the next: (W' delta) (1 - a^2).
inline void run_layer_backward(const NetworkLayer& layer, const NetworkLayer& next,
                               const double* weights, const Block& block, const double* next_delta,
                               std::size_t next_stride, double* delta, std::size_t stride) {
  const WeightView transposed{weights + next.weights, 1, count_inputs(next)};
  multiply<false>(transposed, count_outputs(layer), count_outputs(next), nullptr, next_delta,
                  next_stride, delta, stride);
  const double* a = block.activations + layer.output_row * block.stride;
  for (std::size_t r = 0; r < count_outputs(layer); ++r) {
    for (std::size_t s = 0; s < kBlockRows; s += kWidth) {
      const Vector value = load(a + r * block.stride + s);
      const Vector slope = xsimd::fnma(value, value, Vector(1.0));
      (load(delta + r * stride + s) * slope).store_unaligned(delta + r * stride + s);
    }
  }
}

/// Computes the last hidden layer's delta of one output: its weights times (1 - a^2), times `mask`.
inline void start_backward(const NetworkLayer& layer, const double* output_weights,
                           const Block& block, const double* mask, double* delta) {
  const double* a = block.activations + layer.output_row * block.stride;
  for (std::size_t r = 0; r < count_outputs(layer); ++r) {
    const Vector weight(output_weights[r]);
    for (std::size_t s = 0; s < kBlockRows; s += kWidth) {
      const Vector value = load(a + r * block.stride + s);
      const Vector slope = xsimd::fnma(value, value, Vector(1.0));
      (weight * slope * load(mask + s)).store_unaligned(delta + r * block.stride + s);
    }
  }
}

inline void run_backward(const NetworkShape& shape, const double* weights, const Block& block,
                         std::size_t rows, double* deltas) {
  const std::size_t stride = block.stride, last = shape.layers.size() - 1;
  const auto outputs = static_cast<std::size_t>(shape.outputs());
  double* mask = deltas + outputs * shape.delta_rows * stride;
  for (std::size_t s = 0; s < kBlockRows; ++s) mask[s] = s < rows ? 1.0 : 0.0;
  if (last == 0) return;
  for (std::size_t k = 0; k < outputs; ++k) {
    double* delta = deltas + k * shape.delta_rows * stride;
    const NetworkLayer& output = shape.layers[last];
    start_backward(shape.layers[last - 1], weights + output.weights + k * count_inputs(output),
                   block, mask, delta + shape.layers[last - 1].delta_row * stride);
    for (std::size_t l = last - 1; l-- > 0;) {
      const NetworkLayer &layer = shape.layers[l], &next = shape.layers[l + 1];
      run_layer_backward(layer, next, weights, block, delta + next.delta_row * stride, stride,
                         delta + layer.delta_row * stride, stride);
    }
  }
}

/// First and second derivatives of a layer's values along a direction, in rows of kBlockRows.
struct Tangent {
  double *first, *second;
};

/// Replaces z' and z" by a' and a" of a = tanh z.
inline void bend_tangent(const double* a, std::size_t stride, std::size_t rows, const Tangent& t) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t s = 0; s < kBlockRows; s += kWidth) {
      const std::size_t at = r * kBlockRows + s;
      const Vector value = load(a + r * stride + s), z1 = load(t.first + at);
      const Vector slope = xsimd::fnma(value, value, Vector(1.0)), a1 = slope * z1;
      const Vector a2 = xsimd::fma(slope, load(t.second + at), Vector(-2.0) * value * a1 * z1);
      a1.store_unaligned(t.first + at);
      a2.store_unaligned(t.second + at);
    }
  }
}

inline void calc_second_derivative(const NetworkShape& shape, const double* weights,
                                   const double* direction, const Block& block, double* scratch,
                                   double* second) {
  std::size_t widest = 0;
  for (const int size : shape.sizes) widest = std::max(widest, static_cast<std::size_t>(size));
  Tangent in{scratch, scratch + widest * kBlockRows};
  Tangent out{in.second + widest * kBlockRows, in.second + 2 * widest * kBlockRows};
  std::fill(in.first, out.first, 0.0);  // the inputs are constant
  for (const NetworkLayer& layer : shape.layers) {
    const std::size_t n = count_outputs(layer), m = count_inputs(layer);
    const double* x = block.activations + layer.input_row * block.stride;
    const WeightView v = get_weights(layer, direction);
    // z" = 2 V a' + W a": the first part is doubled in passing.
    multiply<false>(v, n, m, nullptr, in.first, kBlockRows, out.second, kBlockRows);
    for_each_vector(n, kBlockRows, [&](std::size_t at) {
      (load(out.second + at) * Vector(2.0)).store_unaligned(out.second + at);
    });
    const WeightView w = get_weights(layer, weights);
    multiply<true>(w, n, m, nullptr, in.second, kBlockRows, out.second, kBlockRows);
    multiply<false>(v, n, m, direction + layer.biases, x, block.stride, out.first, kBlockRows);
    multiply<true>(w, n, m, nullptr, in.first, kBlockRows, out.first, kBlockRows);
    if (&layer != &shape.layers.back()) {
      bend_tangent(block.activations + layer.output_row * block.stride, block.stride, n, out);
    } else {
      std::copy_n(out.second, n * kBlockRows, second);
    }
    std::swap(in, out);
  }
}

}  // namespace strut
