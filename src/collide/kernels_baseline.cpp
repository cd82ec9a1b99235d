// For every processor of the platform.
#define PERCALE_KERNELS baseline
#define PERCALE_KERNELS_NAME "baseline"
#include "collide/kernels_impl.h"
