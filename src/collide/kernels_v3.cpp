// For x86-64-v3: AVX2.
#define PERCALE_KERNELS v3
#define PERCALE_KERNELS_NAME "x86-64-v3"
#include "collide/kernels_impl.h"
