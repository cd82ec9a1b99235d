#include "springs/kernels.h"

#include "core/processor.h"

namespace percale::springs {

#include "core/kernel_choice.h"

const Kernels& BaselineKernels() {
  return baseline::kKernels;
}

}  // namespace percale::springs
