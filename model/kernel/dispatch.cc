#include "base/parallel/instruction_sets.h"
#include "model/kernel/simulation.h"

STRUT_DECLARE_KERNELS(strut::Kernel, strut_kernel_)

namespace strut {
const std::vector<Kernel>& list_kernels() {
  static const std::vector<Kernel> kernels = STRUT_LIST_KERNELS(Kernel, strut_kernel_);
  return kernels;
}

}  // namespace strut
