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
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma")) {
    kernels.push_back(strut_kernel_avx512());
  }
#endif
#ifdef STRUT_HAS_KERNEL_avx2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(strut_kernel_avx2());
  }
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
