// The training kernels, compiled once per instruction set, with STRUT_ISA as its name.

#include <Eigen/Core>

#include "base/math/matrix_map.h"
#include "base/parallel/instruction_sets.h"
#include "train/network/block_layers.h"

namespace {

using strut::Block;
using strut::GramTile;
using strut::kBlockRows;
using strut::kWidth;
using strut::NetworkLayer;
using strut::NetworkShape;
using strut::Vector;

using strut::ColumnMap;
using strut::ColumnMatrix;
using strut::ConstColumnMap;
using strut::ConstRowMap;
using strut::map_columns;
using strut::map_rows;
using strut::RowMatrix;
using strut::Stride;
using strut::to_index;

// --- one sample ------------------------------------------------------------------------------

/// out = b + W in, for `kVectors` vectors of a layer's padded outputs.
template <std::size_t kVectors>
void predict_patch(const double* packed, std::size_t width, int inputs, const double* in,
                   double* out) {
  Vector sum[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) sum[v] = strut::load(packed + v * kWidth);
  for (int i = 0; i < inputs; ++i) {
    packed += width;
    const Vector x(in[i]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      sum[v] = xsimd::fma(x, strut::load(packed + v * kWidth), sum[v]);
    }
  }
  for (std::size_t v = 0; v < kVectors; ++v) sum[v].store_unaligned(out + v * kWidth);
}

void predict(const NetworkShape& shape, const double* packed, const double* inputs,
             double* outputs) {
  // Padded outputs of two successive layers, used alternately.
  alignas(64) double buffer[2][NetworkShape::kLargestSize];
  const double* in = inputs;
  double* out = buffer[0];
  for (const NetworkLayer& layer : shape.layers) {
    const std::size_t n = strut::count_outputs(layer);
    const std::size_t width = (n + strut::kPadding - 1) / strut::kPadding * strut::kPadding;
    constexpr std::size_t kSmall = strut::kPadding / kWidth,
                          kLarge = 4 * kSmall > 8 ? 8 : 4 * kSmall;
    std::size_t o = 0;
    for (; o + kLarge * kWidth <= width; o += kLarge * kWidth) {
      predict_patch<kLarge>(packed + o, width, layer.inputs, in, out + o);
    }
    for (; o < width; o += kSmall * kWidth) {
      predict_patch<kSmall>(packed + o, width, layer.inputs, in, out + o);
    }
    packed += width * (strut::count_inputs(layer) + 1);
    if (&layer == &shape.layers.back()) {
      std::copy_n(out, n, outputs);
      return;
    }
    for (std::size_t i = 0; i < width; i += kWidth) {
      xsimd::tanh(strut::load(out + i)).store_unaligned(out + i);
    }
    in = out;
    out = in == buffer[0] ? buffer[1] : buffer[0];
  }
}

// --- gradient --------------------------------------------------------------------------------

/// Writes the gradient of one layer, the sum of delta a' over the block, as W by rows, then b.
void store_gradient(const NetworkLayer& layer, const double* delta, const Block& block,
                    double* product, double* gradient) {
  const std::size_t n = strut::count_outputs(layer), m = strut::count_inputs(layer) + 1;
  Eigen::Map<RowMatrix> sums(product, to_index(n), to_index(m));
  sums.noalias() =
      map_rows(delta, n, kBlockRows, kBlockRows) *
      map_columns(block.activations + layer.input_row * block.stride, kBlockRows, m, block.stride);
  for (std::size_t o = 0; o < n; ++o) {
    std::copy_n(product + o * m, m - 1, gradient + layer.weights + o * (m - 1));
    gradient[layer.biases + o] = product[o * m + m - 1];
  }
}

void calc_gradient(const NetworkShape& shape, const double* weights, const Block& block,
                   const double* errors, double* scratch, double* gradient) {
  double* product = scratch + shape.delta_rows * kBlockRows;
  const double* delta = errors;
  for (std::size_t l = shape.layers.size(); l-- > 0;) {
    if (l + 1 < shape.layers.size()) {
      double* next = scratch + shape.layers[l].delta_row * kBlockRows;
      strut::run_layer_backward(shape.layers[l], shape.layers[l + 1], weights, block, delta,
                                kBlockRows, next, kBlockRows);
      delta = next;
    }
    store_gradient(shape.layers[l], delta, block, product, gradient);
  }
}

// --- structured Gram -------------------------------------------------------------------------

/// product = sum_k a_k b_k over the outputs, whose rows are `step` apart.
void sum_products(const double* a, const double* b, std::size_t outputs, std::size_t step,
                  std::size_t depth, double* product) {
  for (std::size_t s = 0; s < depth; s += kWidth) {
    Vector sum(0.0);
    for (std::size_t k = 0; k < outputs; ++k) {
      sum = xsimd::fma(strut::load(a + k * step + s), strut::load(b + k * step + s), sum);
    }
    sum.store_unaligned(product + s);
  }
}

/// Fills the rows of U' of a tile: sum_k delta_i^k delta_j^k for each pair of neurons.
void fill_neuron_pairs(const NetworkShape& shape, const GramTile& tile, const double* deltas,
                       std::size_t stride, std::size_t depth, double* u) {
  const auto outputs = static_cast<std::size_t>(shape.outputs());
  const std::size_t step = shape.delta_rows * stride, last = shape.layers.size() - 1;
  const NetworkLayer &a = shape.layers[tile.first], &b = shape.layers[tile.second];
  if (tile.first == last) {  // the mask: delta_i delta_j is 1 for i = j
    std::copy_n(deltas + outputs * step, depth, u);
    return;
  }
  const bool same = tile.first == tile.second;
  std::size_t i = 0, j = 0;
  const auto move_on = [&] {
    const std::size_t end = same ? i : strut::count_outputs(b) - 1;
    if (j == end)
      ++i, j = 0;
    else
      ++j;
  };
  for (std::size_t skip = 0; skip < tile.first_row; ++skip) move_on();
  for (std::size_t r = 0; r < tile.rows; ++r, u += depth, move_on()) {
    const double* from_i = deltas + (a.delta_row + i) * stride;
    if (tile.second == last) {
      std::copy_n(from_i + j * step, depth, u);  // delta_j^k is 1 for k = j
    } else {
      sum_products(from_i, deltas + (b.delta_row + j) * stride, outputs, step, depth, u);
    }
  }
}

/// Fills the columns of V of a tile: a_p a_q for each pair of inputs.
void fill_input_pairs(const NetworkShape& shape, const GramTile& tile, const Block& chunk,
                      std::size_t depth, double* v) {
  const NetworkLayer &a = shape.layers[tile.first], &b = shape.layers[tile.second];
  for (std::size_t p = 0; p <= strut::count_inputs(a); ++p) {
    const double* left = chunk.activations + (a.input_row + p) * chunk.stride;
    const std::size_t last = tile.first == tile.second ? p : strut::count_inputs(b);
    for (std::size_t q = 0; q <= last; ++q, v += depth) {
      const double* right = chunk.activations + (b.input_row + q) * chunk.stride;
      for (std::size_t s = 0; s < depth; s += kWidth) {
        (strut::load(left + s) * strut::load(right + s)).store_unaligned(v + s);
      }
    }
  }
}

void add_tile(const NetworkShape& shape, const GramTile& tile, const Block& chunk,
              const double* deltas, std::size_t depth, double* scratch, double* sums) {
  ColumnMap product = map_columns(sums + tile.offset, tile.rows, tile.columns, tile.rows);
  for (std::size_t first = 0; first < depth; first += strut::kSlabRows) {
    const std::size_t slab = std::min(strut::kSlabRows, depth - first);
    double* u = scratch;
    double* v = scratch + tile.rows * slab;
    fill_neuron_pairs(shape, tile, deltas + first, chunk.stride, slab, u);
    fill_input_pairs(shape, tile, {chunk.activations + first, chunk.stride}, slab, v);
    product.noalias() +=
        map_rows(u, tile.rows, slab, slab) * map_columns(v, slab, tile.columns, slab);
  }
}

}  // namespace

extern "C" strut::TrainKernel STRUT_ISA_NAME(strut_train_kernel_)();

extern "C" strut::TrainKernel STRUT_ISA_NAME(strut_train_kernel_)() {
  // Eigen splits its sums by the cache sizes. Fixed here: as the processor reports them, results
  // would differ between machines of one instruction set.
  Eigen::setCpuCacheSizes(32 * 1024, 512 * 1024, 4 * 1024 * 1024);
  return {STRUT_ISA_STRING,
          &predict,
          &strut::run_forward,
          &strut::run_backward,
          &calc_gradient,
          &strut::calc_second_derivative,
          &add_tile};
}
