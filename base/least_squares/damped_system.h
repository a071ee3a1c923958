// Solution of (H + mu D) x = b by a multithreaded Cholesky factorization.
#pragma once

#include <cstddef>
#include <vector>

#include "base/least_squares/cholesky.h"

namespace strut {

/// Holds one factorization. Its panels have a fixed width, so results have the same bits on any
/// number of threads.
class DampedSystem {
 public:
  DampedSystem(std::size_t size, int threads, const CholeskyKernel& kernel);

  /// Factors H + damping diag(scale); H by columns, lower triangle. False where the sum is not
  /// positive definite in floating point.
  bool factor(const std::vector<double>& h, const std::vector<double>& scale, double damping);

  /// x = (H + mu D)^-1 x; requires that the last call of `factor` succeeded.
  void solve(std::vector<double>& x) const;

 private:
  void copy(const std::vector<double>& h, const std::vector<double>& scale, double damping);

  std::size_t size_;
  int threads_;
  const CholeskyKernel* kernel_;
  std::vector<double> lower_;
};

}  // namespace strut
