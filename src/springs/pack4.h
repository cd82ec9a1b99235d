// Four doubles at a time, with AVX2 or in plain C++. Included by kernels_impl.h inside the namespace of
// an instruction set, like everything there; never elsewhere.

#if defined(__AVX2__)

struct Pack {
  __m256d v;
};
struct Mask {
  __m256d v;
};
inline Pack Load(const double* p) {
  return {_mm256_loadu_pd(p)};
}
inline void Store(double* p, Pack a) {
  _mm256_storeu_pd(p, a.v);
}
inline Pack All(double s) {
  return {_mm256_set1_pd(s)};
}
inline Pack operator+(Pack a, Pack b) {
  return {_mm256_add_pd(a.v, b.v)};
}
inline Pack operator-(Pack a, Pack b) {
  return {_mm256_sub_pd(a.v, b.v)};
}
inline Pack operator*(Pack a, Pack b) {
  return {_mm256_mul_pd(a.v, b.v)};
}
inline Pack operator/(Pack a, Pack b) {
  return {_mm256_div_pd(a.v, b.v)};
}
inline Pack Sqrt(Pack a) {
  return {_mm256_sqrt_pd(a.v)};
}
inline Mask operator>(Pack a, Pack b) {
  return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)};
}
inline Mask operator<=(Pack a, Pack b) {
  return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)};
}
inline Mask operator&(Mask a, Mask b) {
  return {_mm256_and_pd(a.v, b.v)};
}
inline Mask operator|(Mask a, Mask b) {
  return {_mm256_or_pd(a.v, b.v)};
}
/// `a` where the mask is set, else zero.
inline Pack Where(Mask m, Pack a) {
  return {_mm256_and_pd(m.v, a.v)};
}
/// One bit per lane.
inline unsigned Bits(Mask m) {
  return static_cast<unsigned>(_mm256_movemask_pd(m.v));
}

#else

struct Pack {
  double v[4];
};
struct Mask {
  bool v[4];
};
inline Pack Load(const double* p) {
  return {{p[0], p[1], p[2], p[3]}};
}
inline void Store(double* p, Pack a) {
  for (int i = 0; i < 4; ++i) p[i] = a.v[i];
}
inline Pack All(double s) {
  return {{s, s, s, s}};
}
template <class F>
inline Pack Each(F f) {
  return {{f(0), f(1), f(2), f(3)}};
}
inline Pack operator+(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] + b.v[i]; });
}
inline Pack operator-(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] - b.v[i]; });
}
inline Pack operator*(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] * b.v[i]; });
}
inline Pack operator/(Pack a, Pack b) {
  return Each([&](int i) { return a.v[i] / b.v[i]; });
}
inline Pack Sqrt(Pack a) {
  return Each([&](int i) { return Sqrt(a.v[i]); });
}
inline Mask operator>(Pack a, Pack b) {
  return {{a.v[0] > b.v[0], a.v[1] > b.v[1], a.v[2] > b.v[2], a.v[3] > b.v[3]}};
}
inline Mask operator<=(Pack a, Pack b) {
  return {{a.v[0] <= b.v[0], a.v[1] <= b.v[1], a.v[2] <= b.v[2], a.v[3] <= b.v[3]}};
}
inline Mask operator&(Mask a, Mask b) {
  return {{a.v[0] && b.v[0], a.v[1] && b.v[1], a.v[2] && b.v[2], a.v[3] && b.v[3]}};
}
inline Mask operator|(Mask a, Mask b) {
  return {{a.v[0] || b.v[0], a.v[1] || b.v[1], a.v[2] || b.v[2], a.v[3] || b.v[3]}};
}
inline Pack Where(Mask m, Pack a) {
  return Each([&](int i) { return m.v[i] ? a.v[i] : 0.0; });
}
inline unsigned Bits(Mask m) {
  return static_cast<unsigned>(m.v[0]) | static_cast<unsigned>(m.v[1]) << 1 | static_cast<unsigned>(m.v[2]) << 2 |
         static_cast<unsigned>(m.v[3]) << 3;
}

#endif

constexpr int kLanes = 4;

struct Pack3 {
  Pack x, y, z;
};
inline Pack3 Load3(const double* const axes[3], std::int64_t at) {
  return {Load(axes[0] + at), Load(axes[1] + at), Load(axes[2] + at)};
}
inline Pack3 operator-(const Pack3& a, const Pack3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Pack SquaredLength(const Pack3& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}
