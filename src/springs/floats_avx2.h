// Eight floats at a time, with AVX2, for tests that only rule out. Included by pack.h inside the namespace of an
// instruction set; never elsewhere.

struct FloatPack {
  __m256 v;
};
inline FloatPack LoadFloats(const float* p) {
  return {_mm256_loadu_ps(p)};
}
inline void StoreFloats(float* p, FloatPack a) {
  _mm256_storeu_ps(p, a.v);
}
inline FloatPack AllFloats(float s) {
  return {_mm256_set1_ps(s)};
}
inline FloatPack operator+(FloatPack a, FloatPack b) {
  return {_mm256_add_ps(a.v, b.v)};
}
inline FloatPack operator-(FloatPack a, FloatPack b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
inline FloatPack FloatsOf(__m256d low, __m256d high) {
  return {_mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low))};
}
/// How far eight numbers are before `origin`.
inline FloatPack FloatsBefore(double origin, const double* x) {
  const __m256d o = _mm256_set1_pd(origin);
  return FloatsOf(_mm256_sub_pd(o, _mm256_loadu_pd(x)), _mm256_sub_pd(o, _mm256_loadu_pd(x + 4)));
}
struct FloatMask {
  __m256 v;
};
inline FloatMask operator>(FloatPack a, FloatPack b) {
  return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)};
}
inline FloatMask operator|(FloatMask a, FloatMask b) {
  return {_mm256_or_ps(a.v, b.v)};
}
inline unsigned Bits(FloatMask m) {
  return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}
/// Lanes by `turn` farther on, the first after the last.
template <int turn>
inline FloatPack Turn(FloatPack a) {
  static_assert(turn > 0 && turn <= 4);
  const __m256 halves = _mm256_permute2f128_ps(a.v, a.v, 1);
  if constexpr (turn == 4) return {halves};
  return {
      _mm256_castsi256_ps(_mm256_alignr_epi8(_mm256_castps_si256(halves), _mm256_castps_si256(a.v), 4 * turn % 16))};
}
inline FloatPack Least(FloatPack a, FloatPack b) {
  return {_mm256_min_ps(a.v, b.v)};
}
inline FloatPack Greatest(FloatPack a, FloatPack b) {
  return {_mm256_max_ps(a.v, b.v)};
}
/// Without the sign.
inline FloatPack Size(FloatPack a) {
  return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)};
}
/// Of vectors, one per lane.
inline FloatPack SquaredLength(FloatPack x, FloatPack y, FloatPack z) {
  return {_mm256_fmadd_ps(x.v, x.v, _mm256_fmadd_ps(y.v, y.v, _mm256_mul_ps(z.v, z.v)))};
}
/// A bit for each lane with such a number.
inline unsigned AtMost(FloatPack a, float bound) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, _mm256_set1_ps(bound), _CMP_LE_OQ)));
}
/// from[index[lane]] - origin. All eight must be indices.
inline FloatPack GatherFloats(const double* from, const std::int32_t* index, double origin) {
  const __m256d o = _mm256_set1_pd(origin);
  const __m256d low = _mm256_setr_pd(from[index[0]], from[index[1]], from[index[2]], from[index[3]]);
  const __m256d high = _mm256_setr_pd(from[index[4]], from[index[5]], from[index[6]], from[index[7]]);
  return FloatsOf(_mm256_sub_pd(low, o), _mm256_sub_pd(high, o));
}
/// The first `count` lanes, and numbers far from all others, and from each other, in the rest.
inline FloatPack FarAfter(int count, FloatPack a) {
  const __m256 far = _mm256_setr_ps(1e15f, 2e15f, 3e15f, 4e15f, 5e15f, 6e15f, 7e15f, 8e15f);
  const __m256i first = _mm256_cmpgt_epi32(_mm256_set1_epi32(count), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  return {_mm256_blendv_ps(far, a.v, _mm256_castsi256_ps(first))};
}
