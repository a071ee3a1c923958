// Training a network as a least-squares problem: sums over rows, in blocks, on a team of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "base/least_squares/least_squares.h"
#include "train/data/row_source.h"
#include "train/network/kernel.h"

namespace strut {

struct NetworkProblemOptions {
  /// Number of threads. No result depends on it.
  int threads = 1;
  /// Rows read from the source at a time, rounded up to whole chunks of kChunkRows: a compromise
  /// between memory and the cost of reading. No result depends on it.
  std::size_t batch_rows = 4096;
  /// Number of rows that H is computed from, 0: all; gradient and loss always use all rows. Each
  /// epoch takes the next window of rows, so rows should be in random order. After Y. Ren, D.
  /// Goldfarb, arXiv 1906.02353: useful beyond about 10^5 rows, where H costs 16 times the
  /// gradient.
  std::size_t gram_rows = 0;

  /// Throws InputError naming the field, its value and what is allowed.
  void validate() const;
};

/// Mean of a quantity over rows, and its standard error.
struct RowStatistics {
  double mean = 0.0, error = 0.0;
};

/// e = network(inputs; w) - targets over all rows and outputs.
///
/// Sums run in order over a fixed grid of rows (chunks of kChunkRows, divided into blocks of
/// kBlockRows): H, gradient and loss have the same bits for any number of threads, batch size and
/// storage of the rows. Memory does not depend on the number of rows.
class NetworkProblem : public LeastSquaresProblem {
 public:
  /// Rows whose derivatives are held in memory at a time.
  static constexpr std::size_t kChunkRows = 512;

  /// The source must outlive this. Throws InputError unless it fits the shape.
  NetworkProblem(const NetworkShape& shape, RowSource& source,
                 const NetworkProblemOptions& options = {},
                 const TrainKernel& kernel = get_train_kernel());

  const NetworkShape& shape() const { return shape_; }
  const TrainKernel& kernel() const { return *kernel_; }
  const NetworkProblemOptions& options() const { return options_; }
  std::size_t source_rows() const { return source_rows_; }

  /// Restricts the sums to the first `count` rows of the source, 1 to source_rows().
  void set_rows(std::size_t count);
  std::size_t rows() const { return rows_; }

  std::size_t weight_count() const override { return shape_.weight_count; }
  double residual_count() const override;
  double calc_gram(const double* weights, int epoch, double* h, double* gradient) override;
  double calc_loss(const double* weights) override;
  bool has_second_derivative() const override { return true; }
  void calc_second_gradient(const double* weights, const double* direction,
                            double* gradient) override;

  /// Change of a row's e'e from weights `before` to `after`, over `count` rows from `first` on,
  /// which may lie beyond rows(). Needs memory for 2 `count` numbers.
  RowStatistics calc_loss_change(const double* before, const double* after, std::size_t first,
                                 std::size_t count);

 private:
  struct Workspace {  // one per thread
    std::vector<double> activations, errors, scratch;
  };
  /// Rows of the source from `first` on.
  struct Batch {
    std::size_t first = 0, rows = 0;
    const double *inputs = nullptr, *targets = nullptr;
  };

  template <class F>
  void for_each_batch(std::size_t first, std::size_t count, const F& use);
  template <class F>
  void for_each_block(const Batch& batch, const F& use);
  void run_block(const double* weights, const Batch& batch, std::size_t first, const Block& block);
  double calc_errors(const Batch& batch, std::size_t first, const Block& block,
                     double* errors) const;
  template <class F>
  double calc_gradients(const double* weights, const double* direction, double* gradient,
                        const F& also);
  void start_gram();
  void add_chunk(const double* weights, const Batch& batch, std::size_t first);
  void calc_row_losses(const double* weights, std::size_t first, std::size_t count,
                       std::vector<double>& losses);

  NetworkShape shape_;
  RowSource* source_;
  NetworkProblemOptions options_;
  const TrainKernel* kernel_;
  std::size_t source_rows_, rows_;

  std::vector<Workspace> workspaces_;
  std::vector<double> inputs_, targets_;                // rows of a batch
  std::vector<double> block_losses_, block_gradients_;  // by block of the batch
  GramLayout layout_;
  // Allocated by the first calc_gram: a problem that only validates needs none of them.
  std::vector<double> chunk_activations_, chunk_deltas_, sums_;
  std::vector<std::vector<double>> factors_;  // one per thread
};

}  // namespace strut
