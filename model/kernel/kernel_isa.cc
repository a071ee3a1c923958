// The simulation for one instruction set: compiled once for each, with STRUT_ISA defined as its
// name.

#include "base/math/xsimd_backend.h"
#include "base/parallel/instruction_sets.h"
#include "model/kernel/run_cases.h"
#include "model/rig/rig_system.h"

namespace {

using strut::InputSignal;
using strut::IntegrateOptions;
using strut::LaneResults;
using strut::NativeLanes;
using strut::PreparedCase;
using strut::RigSpec;
using strut::SamplePlan;
using strut::StepOptions;

/// `count` cases, the last of them repeated to fill all lanes.
template <class Pointer>
std::array<Pointer, NativeLanes::kWidth> pad(const Pointer* cases, int count) {
  std::array<Pointer, NativeLanes::kWidth> padded;
  for (int lane = 0; lane < NativeLanes::kWidth; ++lane) {
    padded[static_cast<std::size_t>(lane)] = cases[std::min(lane, count - 1)];
  }
  return padded;
}

unsigned find_starts(PreparedCase* const* cases, int count) {
  const unsigned found = strut::find_starts<NativeLanes>(pad(cases, count).data());
  return found & ((1U << static_cast<unsigned>(count)) - 1U);
}

LaneResults run_lanes(const PreparedCase* const* cases, int count, const IntegrateOptions& options,
                      const SamplePlan& plan) {
  return strut::run_cases<NativeLanes>(pad(cases, count).data(), options, plan);
}

LaneResults run_scalar(const PreparedCase& c, const IntegrateOptions& options,
                       const SamplePlan& plan) {
  const PreparedCase* cases[1] = {&c};
  return strut::run_cases<double>(cases, options, plan);
}

LaneResults run_rigs(const RigSpec* const* specs, int count, const std::vector<InputSignal>& inputs,
                     const StepOptions& options, const SamplePlan& plan) {
  return strut::simulate_rigs<NativeLanes>(pad(specs, count).data(), inputs, options, plan);
}

/// Twelve independent chains hide the latency of two multiply-add units of four cycles each; with
/// the two factors they fit into the sixteen registers of AVX2.
double run_peak_loop(long rounds, double& sink) {
  using Vector = xsimd::batch<double, xsimd::default_arch>;
  constexpr std::size_t kChains = 12;
  // Volatile, so that the compiler cannot fold them; the values remain of order one.
  const volatile double factor = 0.999999, term = 1e-6;
  const Vector a(factor), b(term);
  std::array<Vector, kChains> chain;
  for (std::size_t i = 0; i < kChains; ++i) chain[i] = Vector(0.1 * static_cast<double>(i + 1));
  for (long round = 0; round < rounds; ++round) {
#pragma GCC unroll 12
    for (std::size_t i = 0; i < kChains; ++i) chain[i] = xsimd::fma(chain[i], a, b);
  }
  Vector sum(0.0);
  for (const Vector& c : chain) sum += c;
  sink += xsimd::hadd(sum);
  return 2.0 * static_cast<double>(kChains) * static_cast<double>(NativeLanes::kWidth) *
         static_cast<double>(rounds);
}

}  // namespace

extern "C" strut::Kernel STRUT_ISA_NAME(strut_kernel_)();

extern "C" strut::Kernel STRUT_ISA_NAME(strut_kernel_)() {
  return {STRUT_ISA_STRING, NativeLanes::kWidth, &find_starts,  &run_lanes,
          &run_scalar,      &run_rigs,           &run_peak_loop};
}
