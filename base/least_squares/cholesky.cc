#include "base/least_squares/cholesky.h"

#include "base/parallel/instruction_sets.h"

STRUT_DECLARE_KERNELS(strut::CholeskyKernel, strut_cholesky_)

namespace strut {
const std::vector<CholeskyKernel>& list_cholesky_kernels() {
  static const std::vector<CholeskyKernel> kernels =
      STRUT_LIST_KERNELS(CholeskyKernel, strut_cholesky_);
  return kernels;
}

const CholeskyKernel& get_cholesky_kernel() { return list_cholesky_kernels().front(); }

}  // namespace strut
