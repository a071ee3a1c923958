#include "base/parallel/instruction_sets.h"

namespace strut {

bool has_avx2() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool has_avx512() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

std::vector<const char*> list_instruction_sets() {
  std::vector<const char*> names = {"baseline"};
#ifdef STRUT_HAS_KERNEL_avx2
  if (has_avx2()) names.insert(names.begin(), "avx2");
#endif
#ifdef STRUT_HAS_KERNEL_avx512
  if (has_avx512()) names.insert(names.begin(), "avx512");
#endif
  return names;
}

}  // namespace strut
