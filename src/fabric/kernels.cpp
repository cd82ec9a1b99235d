#include "fabric/kernels.h"

namespace percale::fabric {

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

std::vector<const Kernels*> RunnableKernels() {
  std::vector<const Kernels*> kernels = {&baseline::kKernels};
#if defined(PERCALE_X86_KERNELS)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
    kernels.push_back(&v3::kKernels);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd")) {
      kernels.push_back(&v4::kKernels);
    }
  }
#endif
  return kernels;
}

const Kernels& BestKernels() {
  static const Kernels& best = *RunnableKernels().back();
  return best;
}

}  // namespace percale::fabric
