// Differentiation for one instruction set: compiled once for each, with STRUT_ISA defined as its
// name.

#include "base/math/xsimd_backend.h"
#include "base/parallel/instruction_sets.h"
#include "model/kernel/run_derivatives.h"

namespace {

using strut::DifferentiatedCase;
using strut::NativeLanes;

/// The last of the cases is repeated to fill all lanes.
strut::LaneResults run(const DifferentiatedCase* cases, int count,
                       const strut::IntegrateOptions& options, const strut::SamplePlan& plan) {
  std::array<DifferentiatedCase, NativeLanes::kWidth> padded;
  for (int lane = 0; lane < NativeLanes::kWidth; ++lane) {
    padded[static_cast<std::size_t>(lane)] = cases[std::min(lane, count - 1)];
  }
  return strut::run_derivatives<NativeLanes>(padded.data(), options, plan);
}

}  // namespace

extern "C" strut::DerivativeKernel STRUT_ISA_NAME(strut_derivatives_)();

extern "C" strut::DerivativeKernel STRUT_ISA_NAME(strut_derivatives_)() {
  return {STRUT_ISA_STRING, NativeLanes::kWidth, &run};
}
