// The simulation for one instruction set: compiled once for each, with STRUT_ISA naming it.

#include "model/kernel/run_cases.h"
#include "model/math/xsimd_backend.h"

namespace {

using strut::IntegrateOptions;
using strut::LaneResults;
using strut::NativeLanes;
using strut::PreparedCase;
using strut::SamplePlan;

LaneResults run_lanes(const PreparedCase* const* cases, int count, const IntegrateOptions& options,
                      const SamplePlan& plan) {
  const PreparedCase* padded[NativeLanes::kWidth];
  for (int lane = 0; lane < NativeLanes::kWidth; ++lane) {
    padded[lane] = cases[lane < count ? lane : count - 1];
  }
  return strut::run_cases<NativeLanes>(padded, options, plan);
}

LaneResults run_scalar(const PreparedCase& c, const IntegrateOptions& options,
                       const SamplePlan& plan) {
  const PreparedCase* cases[1] = {&c};
  return strut::run_cases<double>(cases, options, plan);
}

}  // namespace

#define STRUT_JOIN_NAME(a, b) a##b
#define STRUT_KERNEL_NAME(isa) STRUT_JOIN_NAME(strut_kernel_, isa)
#define STRUT_QUOTE_NAME(name) #name
#define STRUT_ISA_STRING(isa) STRUT_QUOTE_NAME(isa)

extern "C" strut::Kernel STRUT_KERNEL_NAME(STRUT_ISA)();

extern "C" strut::Kernel STRUT_KERNEL_NAME(STRUT_ISA)() {
  return {STRUT_ISA_STRING(STRUT_ISA), NativeLanes::kWidth, &run_lanes, &run_scalar};
}
