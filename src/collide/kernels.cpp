#include "collide/kernels.h"

#include "core/processor.h"

namespace percale::collide {

#include "core/kernel_choice.h"

}  // namespace percale::collide
