// A few doubles, and floats, side by side. Included by kernels_impl.h inside the namespace of an
// instruction set, like everything there; never elsewhere.

#if defined(__AVX512F__)
#include "springs/floats_avx2.h"
#include "springs/pack_avx512.h"
#elif defined(__AVX2__)
#include "springs/floats_avx2.h"
#include "springs/pack_avx2.h"
#else
#include "springs/pack_plain.h"
#endif

struct Pack3 {
  Pack x, y, z;
};
inline Pack3 Load3(const double* const axes[3], std::int64_t at) {
  return {Load(axes[0] + at), Load(axes[1] + at), Load(axes[2] + at)};
}
inline Pack3 Gather3(const double* const axes[3], const std::int32_t* index) {
  return {Gather(axes[0], index), Gather(axes[1], index), Gather(axes[2], index)};
}
inline void Store3(double* const axes[3], std::int64_t at, const Pack3& a) {
  Store(axes[0] + at, a.x), Store(axes[1] + at, a.y), Store(axes[2] + at, a.z);
}
/// The axes stand one behind the other, `stride` numbers apart.
inline Pack3 LoadStrided3(const double* from, std::int64_t stride) {
  return {Load(from), Load(from + stride), Load(from + 2 * stride)};
}
inline void StoreStrided3(double* to, std::int64_t stride, const Pack3& a) {
  Store(to, a.x), Store(to + stride, a.y), Store(to + 2 * stride, a.z);
}
inline Pack3 operator+(const Pack3& a, const Pack3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Pack3 operator-(const Pack3& a, const Pack3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Pack3 operator*(const Pack3& a, Pack b) {
  return {a.x * b, a.y * b, a.z * b};
}
inline Pack SquaredLength(const Pack3& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}
inline Pack3 Select(Mask m, const Pack3& a, const Pack3& b) {
  return {Select(m, a.x, b.x), Select(m, a.y, b.y), Select(m, a.z, b.z)};
}
inline Pack3 Zero3() {
  return {All(0), All(0), All(0)};
}
/// The first `count` lanes; the others are not touched, and read as zero.
inline Pack3 LoadFirst3(const double* const axes[3], std::int64_t at, int count) {
  if (count == kLanes) return Load3(axes, at);
  double lanes[3][kLanes] = {};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < count; ++i) lanes[axis][i] = axes[axis][at + i];
  }
  return {Load(lanes[0]), Load(lanes[1]), Load(lanes[2])};
}
inline void StoreFirst3(double* const axes[3], std::int64_t at, const Pack3& a, int count) {
  if (count == kLanes) {
    Store3(axes, at, a);
    return;
  }
  double lanes[3][kLanes];
  Store(lanes[0], a.x), Store(lanes[1], a.y), Store(lanes[2], a.z);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < count; ++i) axes[axis][at + i] = lanes[axis][i];
  }
}

constexpr int kFloatLanes = 8, kPlaceLanes = 8;

struct FloatPack3 {
  FloatPack x, y, z;
};
inline FloatPack SquaredDistance(const FloatPack3& a, const FloatPack3& b) {
  return SquaredLength(a.x - b.x, a.y - b.y, a.z - b.z);
}
