// The kernels of kernels.h. Included by one source file per instruction set, which names the namespace PERCALE_KERNELS
// first. No inline function that other files compile too may be called here: the linker would be free to keep the copy
// that not every processor runs. Templates are safe with a Pack of this namespace's Level.

#include "fabric/kernels.h"
#include "math/pack.h"

namespace percale::fabric::PERCALE_KERNELS {

struct Level;

#if defined(__AVX512F__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
using Doubles = Pack<double, kLanes, Level>;
using Floats = Pack<float, kLanes, Level>;

#include "fabric/kernel_assemble.h"
#include "fabric/kernel_membrane.h"

extern const Kernels kKernels;
const Kernels kKernels = {
    PERCALE_KERNELS_NAME,       MembraneStrains,           MembraneEnergy,
    MembraneDerivatives<false>, MembraneDerivatives<true>, Assemble,
};

}  // namespace percale::fabric::PERCALE_KERNELS
