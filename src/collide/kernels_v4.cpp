// For x86-64-v4: AVX-512.
#define PERCALE_KERNELS v4
#define PERCALE_KERNELS_NAME "x86-64-v4"
#include "collide/kernels_impl.h"
