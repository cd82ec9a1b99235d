#include "springs/kernels.h"

namespace percale::springs {

namespace baseline {
extern const Kernels kKernels;
}
#if defined(PERCALE_X86_KERNELS)
namespace v3 {
extern const Kernels kKernels;
}
namespace v4 {
extern const Kernels kKernels;
}
#endif

const Kernels& BaselineKernels() { return baseline::kKernels; }

const Kernels& BestKernels() {
#if defined(PERCALE_X86_KERNELS)
  static const Kernels& best = []() -> const Kernels& {
    __builtin_cpu_init();
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
    return v4 ? v4::kKernels : v3 ? v3::kKernels : baseline::kKernels;
  }();
  return best;
#else
  return BaselineKernels();
#endif
}

}  // namespace percale::springs
