// Instruction sets: code that is compiled once for each of them and chosen at run time.
//
// A unit NAME_isa.cc is compiled once per instruction set with STRUT_ISA defined as the set's name
// (.ci/cmake/isolate_isa.cmake) and exports one function, STRUT_ISA_NAME(prefix_). The unit that
// chooses calls STRUT_LIST_KERNELS(Kernel, prefix_).
#pragma once

#include <vector>

#define STRUT_JOIN_NAMES_EXPANDED(a, b) a##b
#define STRUT_JOIN_NAMES(a, b) STRUT_JOIN_NAMES_EXPANDED(a, b)
#define STRUT_QUOTE_NAME_EXPANDED(a) #a
#define STRUT_QUOTE_NAME(a) STRUT_QUOTE_NAME_EXPANDED(a)
/// `prefix` followed by the instruction set that the unit is compiled for.
#define STRUT_ISA_NAME(prefix) STRUT_JOIN_NAMES(prefix, STRUT_ISA)
/// That instruction set as a string.
#define STRUT_ISA_STRING STRUT_QUOTE_NAME(STRUT_ISA)

#ifdef STRUT_HAS_KERNEL_avx2
#define STRUT_AVX2_KERNEL(prefix) &prefix##avx2
#else
#define STRUT_AVX2_KERNEL(prefix) nullptr
#endif
#ifdef STRUT_HAS_KERNEL_avx512
#define STRUT_AVX512_KERNEL(prefix) &prefix##avx512
#else
#define STRUT_AVX512_KERNEL(prefix) nullptr
#endif
/// Declares the functions that the compiled units export.
#define STRUT_DECLARE_KERNELS(Kernel, prefix) \
  extern "C" {                                \
  Kernel prefix##baseline();                  \
  Kernel prefix##avx2();                      \
  Kernel prefix##avx512();                    \
  }
/// Returns the kernels of this build that this processor can run, widest first; never empty.
#define STRUT_LIST_KERNELS(Kernel, prefix)                                             \
  strut::list_runnable<Kernel>(STRUT_AVX512_KERNEL(prefix), STRUT_AVX2_KERNEL(prefix), \
                               &prefix##baseline)

namespace strut {

bool has_avx2();
bool has_avx512();

/// Names of the instruction sets of this build that this processor can run, widest first.
std::vector<const char*> list_instruction_sets();

/// Calls the functions whose instruction set this processor has; they are null where this build
/// lacks the instruction set.
template <class Kernel>
std::vector<Kernel> list_runnable(Kernel (*avx512)(), Kernel (*avx2)(), Kernel (*baseline)()) {
  std::vector<Kernel> kernels;
  if (avx512 != nullptr && has_avx512()) kernels.push_back(avx512());
  if (avx2 != nullptr && has_avx2()) kernels.push_back(avx2());
  kernels.push_back(baseline());
  return kernels;
}

}  // namespace strut
