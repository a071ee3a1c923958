// What this processor can run of what is compiled once per instruction set.
#pragma once

#include <vector>

namespace strut {

inline bool has_avx2() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

inline bool has_avx512() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

/// Their names, widest first.
inline std::vector<const char*> list_instruction_sets() {
  std::vector<const char*> names = {"baseline"};
  if (has_avx2()) names.insert(names.begin(), "avx2");
  if (has_avx512()) names.insert(names.begin(), "avx512");
  return names;
}

}  // namespace strut
