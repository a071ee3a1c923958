// What training computes much of, compiled once per instruction set (kernel_isa.cc) and chosen at
// run time. Everything here is serial and knows no files; threads call it side by side.
//
// A block holds kBlockRows samples side by side: row r of a working array is one quantity, its
// columns are samples, so that each operation runs over whole vectors. Columns beyond the last
// sample have inputs 0 and derivatives 0 and so add nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "train/network/gram_layout.h"
#include "train/network/network.h"

namespace strut {

/// Samples of a block.
inline constexpr std::size_t kBlockRows = 64;
/// Samples of which a tile's factors are built at a time: they stay in the second-level cache.
inline constexpr std::size_t kSlabRows = 128;
/// Columns of the predictor's weights are padded to multiples of this: the widest vector.
inline constexpr std::size_t kPadding = 8;

/// The first kBlockRows columns from `activations` on, in an array whose rows are `stride` apart.
struct Block {
  double* activations;  // shape.activation_rows: each layer's values, then a row of ones
  std::size_t stride;
};

/// Fills a block's inputs from `rows` samples, and its rows of ones; the other columns become 0.
void load_inputs(const NetworkShape& shape, const double* inputs, std::size_t rows,
                 const Block& block);

struct TrainKernel {
  const char* isa;  // "baseline", "avx2", "avx512"

  /// One sample through the packed weights of a Predictor.
  void (*predict)(const NetworkShape& shape, const double* packed, const double* inputs,
                  double* outputs);

  /// From a block's inputs to all its activations.
  void (*run_forward)(const NetworkShape& shape, const double* weights, const Block& block);

  /// For each output k the derivatives of y_k by the neurons' sums: `deltas` holds, with the stride
  /// of the block, shape.delta_rows rows for each k, and last a row that is 1 for the first `rows`
  /// samples, else 0: the derivative of an output by its own sum.
  void (*run_backward)(const NetworkShape& shape, const double* weights, const Block& block,
                       std::size_t rows, double* deltas);

  /// gradient = J' e of a block, e being outputs() rows of kBlockRows; `scratch` as the next says.
  void (*calc_gradient)(const NetworkShape& shape, const double* weights, const Block& block,
                        const double* errors, double* scratch, double* gradient);

  /// second = d2 y / dt2 of the outputs along weights + t direction, at a block whose activations
  /// are there: outputs() rows of kBlockRows. Forward mode: with z = W a + b and a = tanh z,
  ///   z' = W a' + V a + v,  z" = W a" + 2 V a',  a' = (1 - a^2) z',
  ///   a" = (1 - a^2) z" - 2 a a' z'.
  void (*calc_second_derivative)(const NetworkShape& shape, const double* weights,
                                 const double* direction, const Block& block, double* scratch,
                                 double* second);

  /// Adds the samples of a chunk (`depth` columns, a multiple of kBlockRows) to a tile of the
  /// structured Gram matrix: gram_layout.h. `scratch`: (rows + columns) * kSlabRows numbers.
  void (*add_tile)(const NetworkShape& shape, const GramTile& tile, const Block& chunk,
                   const double* deltas, std::size_t depth, double* scratch, double* sums);
};

/// Numbers of scratch that calc_gradient and calc_second_derivative need.
std::size_t get_scratch_size(const NetworkShape& shape);

/// Kernels that this processor can run, widest first; never empty.
const std::vector<TrainKernel>& list_train_kernels();
/// The widest.
const TrainKernel& get_train_kernel();

}  // namespace strut
