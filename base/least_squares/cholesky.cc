#include "base/least_squares/cholesky.h"

#include "base/parallel/instruction_sets.h"

extern "C" {
strut::CholeskyKernel strut_cholesky_baseline();
#ifdef STRUT_HAS_KERNEL_avx2
strut::CholeskyKernel strut_cholesky_avx2();
#endif
#ifdef STRUT_HAS_KERNEL_avx512
strut::CholeskyKernel strut_cholesky_avx512();
#endif
}

namespace strut {
namespace {

std::vector<CholeskyKernel> find_kernels() {
  std::vector<CholeskyKernel> kernels;
#ifdef STRUT_HAS_KERNEL_avx512
  if (has_avx512()) kernels.push_back(strut_cholesky_avx512());
#endif
#ifdef STRUT_HAS_KERNEL_avx2
  if (has_avx2()) kernels.push_back(strut_cholesky_avx2());
#endif
  kernels.push_back(strut_cholesky_baseline());
  return kernels;
}

}  // namespace

const std::vector<CholeskyKernel>& list_cholesky_kernels() {
  static const std::vector<CholeskyKernel> kernels = find_kernels();
  return kernels;
}

const CholeskyKernel& get_cholesky_kernel() { return list_cholesky_kernels().front(); }

}  // namespace strut
