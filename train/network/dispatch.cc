#include <algorithm>

#include "base/parallel/instruction_sets.h"
#include "train/network/kernel.h"

STRUT_DECLARE_KERNELS(strut::TrainKernel, strut_train_kernel_)

namespace strut {

void load_inputs(const NetworkShape& shape, const double* inputs, std::size_t rows,
                 const Block& block) {
  const auto count = static_cast<std::size_t>(shape.inputs());
  for (std::size_t i = 0; i < count; ++i) {
    double* row = block.activations + i * block.stride;
    for (std::size_t s = 0; s < rows; ++s) row[s] = inputs[s * count + i];
    std::fill(row + rows, row + kBlockRows, 0.0);
  }
  for (const NetworkLayer& layer : shape.layers) {
    const std::size_t ones = layer.input_row + static_cast<std::size_t>(layer.inputs);
    std::fill_n(block.activations + ones * block.stride, kBlockRows, 1.0);
  }
}

std::size_t get_scratch_size(const NetworkShape& shape) {
  std::size_t widest = static_cast<std::size_t>(shape.inputs()), largest = 0;
  for (const NetworkLayer& layer : shape.layers) {
    const auto n = static_cast<std::size_t>(layer.outputs);
    widest = std::max(widest, n);
    largest = std::max(largest, n * (static_cast<std::size_t>(layer.inputs) + 1));
  }
  return std::max(shape.delta_rows * kBlockRows + largest, 4 * widest * kBlockRows);
}

const std::vector<TrainKernel>& list_train_kernels() {
  static const std::vector<TrainKernel> kernels =
      STRUT_LIST_KERNELS(TrainKernel, strut_train_kernel_);
  return kernels;
}

const TrainKernel& get_train_kernel() { return list_train_kernels().front(); }

}  // namespace strut
