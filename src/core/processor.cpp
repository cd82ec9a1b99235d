#include "core/processor.h"

namespace percale {

InstructionSet BestInstructionSet() {
#if defined(PERCALE_X86_KERNELS)
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (!v3) return InstructionSet::Baseline;
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
                  __builtin_cpu_supports("avx512cd");
  return v4 ? InstructionSet::V4 : InstructionSet::V3;
#else
  return InstructionSet::Baseline;
#endif
}

}  // namespace percale
