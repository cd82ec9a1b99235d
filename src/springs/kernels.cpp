#include "springs/kernels.h"

#include <bit>

#include "core/processor.h"

namespace percale::springs {

#include "core/kernel_choice.h"

int ForceRingSize(int numWidth) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(numWidth + kGridPad)));
}
int IntegrateScratch(int numWidth) {
  return 6 * (ForceRingSize(numWidth) + kGridPad);
}
int MarkScratch(int numWidth) {
  return 9 * (RoundUpToPad(numWidth) + 3 * kGridPad);
}

const Kernels& BaselineKernels() {
  return baseline::kKernels;
}

}  // namespace percale::springs
