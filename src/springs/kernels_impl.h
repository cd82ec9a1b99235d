// The kernels of kernels.h. Included by one source file per instruction set, which names the
// namespace PERCALE_KERNELS first. No header with inline functions that other files compile too may
// be included here: the linker would be free to keep the copy that not every processor runs.

#include <math.h>
#include <string.h>

#include "springs/kernels.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif
#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace percale::springs::PERCALE_KERNELS {
namespace {

/// On lambdas of an inner loop: what they capture stays in registers.
#if defined(_MSC_VER)
#define PERCALE_INLINE [[msvc::forceinline]]
#else
#define PERCALE_INLINE __attribute__((always_inline))
#endif

#if defined(_MSC_VER)
inline double Sqrt(double v) {
  return ::sqrt(v);
}
inline double Floor(double v) {
  return ::floor(v);
}
inline int LowestBit(std::uint64_t bits) {
  unsigned long index;
  _BitScanForward64(&index, bits);
  return static_cast<int>(index);
}
inline int BitCount(std::uint64_t bits) {
  return static_cast<int>(__popcnt64(bits));
}
#else
inline double Sqrt(double v) {
  return __builtin_sqrt(v);
}
inline double Floor(double v) {
  return __builtin_floor(v);
}
inline int LowestBit(std::uint64_t bits) {
  return __builtin_ctzll(bits);
}
inline int BitCount(std::uint64_t bits) {
  return __builtin_popcountll(bits);
}
#endif

#include "springs/pack.h"

/// Kinds in creation order, as in mesh/cloth_model.h.
enum { kLeft, kUp, kUpperLeft, kUpperRight, kTwoLeft, kTwoUp, kKinds };
constexpr int kDi[kKinds] = {-1, 0, -1, 1, -2, 0};
constexpr int kDj[kKinds] = {0, -1, -1, -1, 0, -2};

/// From the index of a spring's creator to that of its other end, for each kind.
struct Steps {
  std::int64_t of[kKinds];
  explicit Steps(std::int64_t numWidth) {
    for (int kind = 0; kind < kKinds; ++kind) of[kind] = kDj[kind] * numWidth + kDi[kind];
  }
  std::int64_t operator[](int kind) const { return of[kind]; }
};

/// Where something stands in a ring; its size is a power of two.
inline std::int64_t Slot(std::int64_t at, std::int64_t size) {
  return at & (size - 1);
}

#include "springs/kernel_colliders.h"
#include "springs/kernel_contacts.h"
#include "springs/kernel_forces.h"
#include "springs/kernel_strain.h"

}  // namespace

extern const Kernels kKernels = {PERCALE_KERNELS_NAME, Integrate, MarkLongSprings, LimitStrain,   GreatestStretch,
                                 ElasticEnergy,        BoxKeys,   SeparateBuckets, CollideSphere, CollidePlane};

}  // namespace percale::springs::PERCALE_KERNELS
