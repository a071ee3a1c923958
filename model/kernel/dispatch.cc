#include "base/parallel/instruction_sets.h"
#include "model/kernel/simulation.h"

extern "C" {
strut::Kernel strut_kernel_baseline();
#ifdef STRUT_HAS_KERNEL_avx2
strut::Kernel strut_kernel_avx2();
#endif
#ifdef STRUT_HAS_KERNEL_avx512
strut::Kernel strut_kernel_avx512();
#endif
}

namespace strut {
namespace {

std::vector<Kernel> find_kernels() {
  std::vector<Kernel> kernels;
#ifdef STRUT_HAS_KERNEL_avx512
  if (has_avx512()) kernels.push_back(strut_kernel_avx512());
#endif
#ifdef STRUT_HAS_KERNEL_avx2
  if (has_avx2()) kernels.push_back(strut_kernel_avx2());
#endif
  kernels.push_back(strut_kernel_baseline());
  return kernels;
}

}  // namespace

const std::vector<Kernel>& list_kernels() {
  static const std::vector<Kernel> kernels = find_kernels();
  return kernels;
}

}  // namespace strut
