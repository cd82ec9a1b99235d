#include "springs/kernels.h"

namespace percale::springs {

namespace baseline {
extern const Kernels kKernels;
}
#if defined(PERCALE_X86_KERNELS)
namespace v3 {
extern const Kernels kKernels;
}
#endif

const Kernels& BaselineKernels() {
  return baseline::kKernels;
}

// No version for x86-64-v4: measured on Zen 4, AVX-512 was no faster than AVX2.
const Kernels& BestKernels() {
#if defined(PERCALE_X86_KERNELS)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
    return v3::kKernels;
  }
#endif
  return BaselineKernels();
}

}  // namespace percale::springs
