#include "train/network/network_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "base/parallel/team.h"

namespace strut {
namespace {

std::size_t round_up(std::size_t value, std::size_t unit) {
  return (value + unit - 1) / unit * unit;
}

/// Maximum rows whose gradients, one per block, are held in memory at a time.
constexpr std::size_t kMaxGradientBatch = 4096;

}  // namespace

void NetworkProblemOptions::validate() const {
  if (threads < 1 || threads > 1024) {
    throw InputError(fmt::format("threads: {}; allowed: 1 to 1024", threads));
  }
  if (batch_rows < 1) throw InputError("batch_rows: 0; allowed: at least 1");
}

NetworkProblem::NetworkProblem(const NetworkShape& shape, RowSource& source,
                               const NetworkProblemOptions& options, const TrainKernel& kernel)
    : shape_(shape),
      source_(&source),
      options_(options),
      kernel_(&kernel),
      source_rows_(source.row_count()),
      rows_(source_rows_),
      layout_(shape) {
  options_.validate();
  if (source.input_count() != shape.inputs() || source.target_count() != shape.outputs()) {
    throw InputError(fmt::format("network: {} inputs and {} outputs; the data have {} and {}",
                                 shape.inputs(), shape.outputs(), source.input_count(),
                                 source.target_count()));
  }
  if (source_rows_ == 0) throw InputError("network: the data have no rows");
  const std::size_t batch =
      std::min(round_up(options_.batch_rows, kChunkRows), round_up(source_rows_, kChunkRows));
  options_.batch_rows = batch;
  inputs_.resize(batch * static_cast<std::size_t>(shape.inputs()));
  targets_.resize(batch * static_cast<std::size_t>(shape.outputs()));
  workspaces_.resize(static_cast<std::size_t>(options_.threads));
  for (Workspace& workspace : workspaces_) {
    workspace.activations.resize(shape.activation_rows * kBlockRows);
    workspace.errors.resize(static_cast<std::size_t>(shape.outputs()) * kBlockRows);
    workspace.scratch.resize(get_scratch_size(shape));
  }
}

void NetworkProblem::set_rows(std::size_t count) {
  rows_ = std::clamp(count, std::size_t{1}, source_rows_);
}

double NetworkProblem::residual_count() const {
  return static_cast<double>(rows_) * shape_.outputs();
}

template <class F>
void NetworkProblem::for_each_batch(std::size_t first, std::size_t count, const F& use) {
  for (std::size_t done = 0; done < count;) {
    const Batch batch{first + done, std::min(options_.batch_rows, count - done), inputs_.data(),
                      targets_.data()};
    source_->read(batch.first, batch.rows, inputs_.data(), targets_.data());
    use(batch);
    done += batch.rows;
  }
}

/// Calls use(index of the block, its first row in the batch, workspace of the thread).
template <class F>
void NetworkProblem::for_each_block(const Batch& batch, const F& use) {
  const std::size_t blocks = (batch.rows + kBlockRows - 1) / kBlockRows;
  share_items(options_.threads, blocks, [&](std::size_t b, int thread) {
    use(b, b * kBlockRows, workspaces_[static_cast<std::size_t>(thread)]);
  });
}

void NetworkProblem::run_block(const double* weights, const Batch& batch, std::size_t first,
                               const Block& block) {
  const std::size_t rows = std::min(kBlockRows, batch.rows - first);
  load_inputs(shape_, batch.inputs + first * static_cast<std::size_t>(shape_.inputs()), rows,
              block);
  kernel_->run_forward(shape_, weights, block);
}

/// Writes e of a block, 0 beyond its rows; returns e'e.
double NetworkProblem::calc_errors(const Batch& batch, std::size_t first, const Block& block,
                                   double* errors) const {
  const std::size_t rows = std::min(kBlockRows, batch.rows - first);
  const auto outputs = static_cast<std::size_t>(shape_.outputs());
  double sum = 0.0;
  for (std::size_t o = 0; o < outputs; ++o) {
    const double* y = block.activations + (shape_.layers.back().output_row + o) * block.stride;
    const double* t = batch.targets + first * outputs + o;
    double* e = errors + o * kBlockRows;
    for (std::size_t s = 0; s < rows; ++s) {
      e[s] = y[s] - t[s * outputs];
      sum += e[s] * e[s];
    }
    std::fill(e + rows, e + kBlockRows, 0.0);
  }
  return sum;
}

double NetworkProblem::calc_loss(const double* weights) {
  double loss = 0.0;
  for_each_batch(0, rows_, [&](const Batch& batch) {
    block_losses_.resize((batch.rows + kBlockRows - 1) / kBlockRows);
    for_each_block(batch, [&](std::size_t b, std::size_t first, Workspace& workspace) {
      const Block block{workspace.activations.data(), kBlockRows};
      run_block(weights, batch, first, block);
      block_losses_[b] = calc_errors(batch, first, block, workspace.errors.data());
    });
    for (const double block_loss : block_losses_) loss += block_loss;
  });
  return loss;
}

/// gradient = J'e, or J'e" along `direction` if given; returns e'e. Calls also(batch) for each
/// batch.
template <class F>
double NetworkProblem::calc_gradients(const double* weights, const double* direction,
                                      double* gradient, const F& also) {
  const std::size_t count = shape_.weight_count;
  std::fill_n(gradient, count, 0.0);
  double loss = 0.0;
  const auto add_part = [&](const Batch& batch) {
    const std::size_t blocks = (batch.rows + kBlockRows - 1) / kBlockRows;
    block_losses_.resize(blocks);
    block_gradients_.resize(blocks * count);
    for_each_block(batch, [&](std::size_t b, std::size_t first, Workspace& workspace) {
      const Block block{workspace.activations.data(), kBlockRows};
      run_block(weights, batch, first, block);
      double* errors = workspace.errors.data();
      block_losses_[b] = calc_errors(batch, first, block, errors);
      if (direction != nullptr) {
        kernel_->calc_second_derivative(shape_, weights, direction, block, workspace.scratch.data(),
                                        errors);
        const std::size_t rows = std::min(kBlockRows, batch.rows - first);
        for (std::size_t o = 0; o < static_cast<std::size_t>(shape_.outputs()); ++o) {
          std::fill(errors + o * kBlockRows + rows, errors + (o + 1) * kBlockRows, 0.0);
        }
      }
      kernel_->calc_gradient(shape_, weights, block, errors, workspace.scratch.data(),
                             block_gradients_.data() + b * count);
    });
    for (std::size_t b = 0; b < blocks; ++b) {
      loss += block_losses_[b];
      const double* part = block_gradients_.data() + b * count;
      for (std::size_t i = 0; i < count; ++i) gradient[i] += part[i];
    }
  };
  for_each_batch(0, rows_, [&](const Batch& batch) {
    also(batch);
    for (std::size_t done = 0; done < batch.rows; done += kMaxGradientBatch) {
      add_part({batch.first + done, std::min(kMaxGradientBatch, batch.rows - done),
                batch.inputs + done * static_cast<std::size_t>(shape_.inputs()),
                batch.targets + done * static_cast<std::size_t>(shape_.outputs())});
    }
  });
  return loss;
}

/// Adds up to kChunkRows rows of a batch to the sums.
void NetworkProblem::add_chunk(const double* weights, const Batch& batch, std::size_t first) {
  const std::size_t rows = std::min(kChunkRows, batch.rows - first);
  const std::size_t blocks = (rows + kBlockRows - 1) / kBlockRows;
  const Block chunk{chunk_activations_.data(), kChunkRows};
  share_items(options_.threads, blocks, [&](std::size_t b, int) {
    const std::size_t column = b * kBlockRows;
    const Block block{chunk.activations + column, kChunkRows};
    run_block(weights, batch, first + column, block);
    kernel_->run_backward(shape_, weights, block, std::min(kBlockRows, rows - column),
                          chunk_deltas_.data() + column);
  });
  share_items(options_.threads, layout_.tiles.size(), [&](std::size_t t, int thread) {
    kernel_->add_tile(shape_, layout_.tiles[t], chunk, chunk_deltas_.data(), blocks * kBlockRows,
                      factors_[static_cast<std::size_t>(thread)].data(), sums_.data());
  });
}

void NetworkProblem::start_gram() {
  const auto outputs = static_cast<std::size_t>(shape_.outputs());
  chunk_activations_.resize(shape_.activation_rows * kChunkRows);
  chunk_deltas_.resize((outputs * shape_.delta_rows + 1) * kChunkRows);
  factors_.resize(workspaces_.size());
  for (std::vector<double>& factors : factors_) {
    factors.resize(layout_.largest_factors * kSlabRows);
  }
  sums_.assign(layout_.sum_count, 0.0);
}

double NetworkProblem::calc_gram(const double* weights, int epoch, double* h, double* gradient) {
  start_gram();
  const auto add_gram = [&](const Batch& batch) {
    for (std::size_t row = 0; row < batch.rows; row += kChunkRows) add_chunk(weights, batch, row);
  };
  double loss = 0.0;
  const std::size_t wanted = options_.gram_rows;
  if (wanted > 0 && wanted < rows_) {
    const std::size_t windows = rows_ / wanted;  // remaining rows are not used
    for_each_batch(static_cast<std::size_t>(epoch) % windows * wanted, wanted, add_gram);
    const double factor = static_cast<double>(rows_) / static_cast<double>(wanted);
    for (double& sum : sums_) sum *= factor;
    loss = calc_gradients(weights, nullptr, gradient, [](const Batch&) {});
  } else {
    loss = calc_gradients(weights, nullptr, gradient, add_gram);
  }
  share_items(options_.threads, layout_.tiles.size(),
              [&](std::size_t t, int) { store_tile(shape_, layout_.tiles[t], sums_.data(), h); });
  return loss;
}

void NetworkProblem::calc_second_gradient(const double* weights, const double* direction,
                                          double* gradient) {
  calc_gradients(weights, direction, gradient, [](const Batch&) {});
}

void NetworkProblem::calc_row_losses(const double* weights, std::size_t first, std::size_t count,
                                     std::vector<double>& losses) {
  losses.resize(count);
  for_each_batch(first, count, [&](const Batch& batch) {
    for_each_block(batch, [&](std::size_t, std::size_t row, Workspace& workspace) {
      const Block block{workspace.activations.data(), kBlockRows};
      run_block(weights, batch, row, block);
      const double* e = workspace.errors.data();
      calc_errors(batch, row, block, workspace.errors.data());
      const std::size_t rows = std::min(kBlockRows, batch.rows - row);
      for (std::size_t s = 0; s < rows; ++s) {
        double sum = 0.0;
        for (int o = 0; o < shape_.outputs(); ++o) {
          const double value = e[static_cast<std::size_t>(o) * kBlockRows + s];
          sum += value * value;
        }
        losses[batch.first - first + row + s] = sum;
      }
    });
  });
}

RowStatistics NetworkProblem::calc_loss_change(const double* before, const double* after,
                                               std::size_t first, std::size_t count) {
  std::vector<double> old_losses, losses;
  calc_row_losses(before, first, count, old_losses);
  calc_row_losses(after, first, count, losses);
  const auto n = static_cast<double>(count);
  RowStatistics change;
  for (std::size_t i = 0; i < count; ++i) change.mean += (losses[i] - old_losses[i]) / n;
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = losses[i] - old_losses[i] - change.mean;
    squares += off * off;
  }
  change.error = std::sqrt(squares / (n * std::max(1.0, n - 1.0)));
  return change;
}

}  // namespace strut
