// Eight floats, or points of few bits, at a time, with AVX2, for tests that only rule out. Included by pack.h inside
// the namespace of an instruction set; never elsewhere.

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
inline FloatPack operator-(FloatPack a, FloatPack b) {
  return {_mm256_sub_ps(a.v, b.v)};
}
/// How far eight numbers are before `origin`.
inline FloatPack FloatsBefore(double origin, const double* x) {
  const __m256d o = _mm256_set1_pd(origin);
  return {_mm256_set_m128(_mm256_cvtpd_ps(_mm256_sub_pd(o, _mm256_loadu_pd(x + 4))),
                          _mm256_cvtpd_ps(_mm256_sub_pd(o, _mm256_loadu_pd(x))))};
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

/// Eight points, whose coordinates are whole numbers below 2^14: x and y, and z and 0, in 16 bits each.
struct Places {
  __m256i xy, z;
};
/// Eight whole numbers.
struct Ints {
  __m256i v;
};
/// from[index[lane]], each of which has x in its lowest 16 bits, then y, then z, then zeros.
inline Places GatherPlaces(const std::uint64_t* from, const std::int32_t* index) {
  const auto at = [&](int i) { return static_cast<long long>(from[index[i]]); };
  const __m256 a = _mm256_castsi256_ps(_mm256_setr_epi64x(at(0), at(1), at(4), at(5)));
  const __m256 b = _mm256_castsi256_ps(_mm256_setr_epi64x(at(2), at(3), at(6), at(7)));
  return {_mm256_castps_si256(_mm256_shuffle_ps(a, b, 0x88)), _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0xdd))};
}
/// Eight times the same.
inline Places AllPlaces(std::uint64_t place) {
  return {_mm256_set1_epi32(static_cast<int>(place)), _mm256_set1_epi32(static_cast<int>(place >> 32))};
}
inline void StorePlaces(std::int32_t* xy, std::int32_t* z, Places a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(xy), a.xy);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(z), a.z);
}
inline Places LoadPlaces(const std::int32_t* xy, const std::int32_t* z) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(xy)),
          _mm256_loadu_si256(reinterpret_cast<const __m256i*>(z))};
}
/// One of those that were stored, eight times.
inline Places AllPlaces(const std::int32_t* xy, const std::int32_t* z) {
  return {_mm256_set1_epi32(*xy), _mm256_set1_epi32(*z)};
}
/// The first `count` lanes, which is 2 at least; the others are 2^13 or more from these, and from each other, in a
/// fourth dimension.
inline Places FirstPlaces(int count, Places a) {
  constexpr int kApart = 1 << 29;  // 2^13 in the upper half, where differences come round: there are eight such places
  const __m256i beyond =
      _mm256_setr_epi32(kApart, kApart, kApart, 2 * kApart, 3 * kApart, -4 * kApart, -3 * kApart, -2 * kApart);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i first = _mm256_cmpgt_epi32(_mm256_set1_epi32(count), lanes);
  return {a.xy, _mm256_or_si256(a.z, _mm256_andnot_si256(first, beyond))};
}
/// Lanes by `turn` farther on, the first after the last.
template <int turn>
inline Places Turn(Places a) {
  static_assert(turn > 0 && turn <= 4);
  const auto turned = [](__m256i v) {
    const __m256i halves = _mm256_permute2x128_si256(v, v, 1);
    return turn == 4 ? halves : _mm256_alignr_epi8(halves, v, 4 * turn % 16);
  };
  return {turned(a.xy), turned(a.z)};
}
inline Ints SquaredDistance(Places a, Places b) {
  const __m256i xy = _mm256_sub_epi16(a.xy, b.xy), z = _mm256_sub_epi16(a.z, b.z);
  return {_mm256_add_epi32(_mm256_madd_epi16(xy, xy), _mm256_madd_epi16(z, z))};
}
inline Ints AllInts(std::int32_t s) {
  return {_mm256_set1_epi32(s)};
}
inline Ints Least(Ints a, Ints b) {
  return {_mm256_min_epi32(a.v, b.v)};
}
/// A bit for each lane below the bound.
inline unsigned Below(Ints a, std::int32_t bound) {
  return static_cast<unsigned>(
      _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_set1_epi32(bound), a.v))));
}
