#include "fabric/kernels.h"

#include "core/processor.h"

namespace percale::fabric {

#include "core/kernel_choice.h"

}  // namespace percale::fabric
