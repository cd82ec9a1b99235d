// The kernels of kernels.h. Included by one source file per instruction set, which names the namespace PERCALE_KERNELS
// first. No inline function that other files compile too may be called here: the linker would be free to keep the copy
// that not every processor runs. Templates are safe with a Pack of this namespace's Level.

#include <utility>

#include "fabric/kernels.h"
#include "math/pack.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace percale::fabric::PERCALE_KERNELS {

struct Level;

constexpr int kLanes = kDoubleLanes;
using Doubles = Pack<double, kLanes, Level>;
using Floats = Pack<float, kLanes, Level>;

#include "fabric/kernel_assemble.h"
#include "fabric/kernel_membrane.h"
#include "fabric/kernel_plates.h"
#include "fabric/kernel_rows.h"
#include "fabric/kernel_wind.h"

extern const Kernels kKernels;
const Kernels kKernels = {
    .name = PERCALE_KERNELS_NAME,
    .membraneStrain = MembraneStrains,
    .membraneStretch = MembraneStretches,
    .membraneEnergy = MembraneEnergy,
    .membraneGradient = MembraneDerivatives<false>,
    .membraneTangent = MembraneDerivatives<true>,
    .plateForces = PlateForces,
    .windLoads = WindLoads,
    .assemble = Assemble,
    .multiply = Multiply,
    .residual = Residual,
    .smooth = Smooth,
};

}  // namespace percale::fabric::PERCALE_KERNELS
