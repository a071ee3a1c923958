// The numerical kernels of training, compiled once per instruction set (kernel_isa.cc) and selected
// at run time. They are serial and thread-safe, and know no files.
//
// A block holds kBlockRows samples side by side: row r of a working array is one quantity, its
// columns are samples, so that each operation runs over whole vectors. Columns beyond the last
// sample have inputs 0 and derivatives 0, so that they contribute nothing.
#pragma once

#include <cstddef>
#include <vector>

#include "train/network/gram_layout.h"
#include "train/network/shape.h"

namespace strut {

/// Samples of a block.
inline constexpr std::size_t kBlockRows = 64;
/// Samples per slab of a tile's factors: a slab fits in the second-level cache.
inline constexpr std::size_t kSlabRows = 128;
/// Columns of the predictor's weights are padded to multiples of this, the widest vector.
inline constexpr std::size_t kPadding = 8;

/// kBlockRows columns of an array whose rows are `stride` apart, from `activations` on.
struct Block {
  double* activations;  // shape.activation_rows: each layer's values, then a row of ones
  std::size_t stride;
};

/// Fills a block's inputs from `rows` samples and its rows of ones; the other columns become 0.
void load_inputs(const NetworkShape& shape, const double* inputs, std::size_t rows,
                 const Block& block);

struct TrainKernel {
  const char* isa;  // "baseline", "avx2", "avx512"

  /// Evaluates one sample with the packed weights of a Predictor.
  void (*predict)(const NetworkShape& shape, const double* packed, const double* inputs,
                  double* outputs);

  /// Computes all activations of a block from its inputs.
  void (*run_forward)(const NetworkShape& shape, const double* weights, const Block& block);

  /// Computes for each output k the derivatives of y_k by the neurons' sums: `deltas` holds, with
  /// the stride of the block, shape.delta_rows rows for each k and one last row, the derivative of
  /// an output by its own sum: 1 for the first `rows` samples, else 0.
  void (*run_backward)(const NetworkShape& shape, const double* weights, const Block& block,
                       std::size_t rows, double* deltas);

  /// gradient = J' e of a block; `errors`: e, outputs() rows of kBlockRows; `scratch`:
  /// get_scratch_size(shape) numbers.
  void (*calc_gradient)(const NetworkShape& shape, const double* weights, const Block& block,
                        const double* errors, double* scratch, double* gradient);

  /// second = d2 y / dt2 of the outputs along weights + t direction, at a block whose activations
  /// are computed: outputs() rows of kBlockRows. Forward mode: with z = W a + b and a = tanh z,
  ///   z' = W a' + V a + v,  z" = W a" + 2 V a',  a' = (1 - a^2) z',
  ///   a" = (1 - a^2) z" - 2 a a' z'.
  void (*calc_second_derivative)(const NetworkShape& shape, const double* weights,
                                 const double* direction, const Block& block, double* scratch,
                                 double* second);

  /// Adds the samples of a chunk (`depth` columns, a multiple of kBlockRows) to a tile of the
  /// structured Gram matrix (gram_layout.h). `scratch`: (rows + columns) * kSlabRows numbers.
  void (*add_tile)(const NetworkShape& shape, const GramTile& tile, const Block& chunk,
                   const double* deltas, std::size_t depth, double* scratch, double* sums);
};

/// Size of the scratch array of calc_gradient and calc_second_derivative.
std::size_t get_scratch_size(const NetworkShape& shape);

/// The kernels that this processor can run, widest instruction set first; never empty.
const std::vector<TrainKernel>& list_train_kernels();
/// The kernel of the widest instruction set.
const TrainKernel& get_train_kernel();

}  // namespace strut
