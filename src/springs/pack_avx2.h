// Four doubles at a time, with AVX2. Included by pack.h inside the namespace of an instruction set; never elsewhere.
// What the functions do is said in pack_avx512.h.

constexpr int kLanes = 4;

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
inline Mask operator^(Mask a, Mask b) {
  return {_mm256_xor_pd(a.v, b.v)};
}
inline Pack Select(Mask m, Pack a, Pack b) {
  return {_mm256_blendv_pd(b.v, a.v, m.v)};
}
inline Pack Where(Mask m, Pack a) {
  return {_mm256_and_pd(m.v, a.v)};
}
inline Pack Max(Pack a, Pack b) {
  return {_mm256_max_pd(a.v, b.v)};
}
/// Lanes that are farther from zero than the bound, or not a number.
inline Mask Outside(Pack a, double bound) {
  const __m256d size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v);
  return {_mm256_cmp_pd(size, _mm256_set1_pd(bound), _CMP_NLE_UQ)};
}
/// The lanes before `count`, which is at most kLanes.
inline Mask FirstLanes(int count) {
  return {_mm256_cmp_pd(_mm256_setr_pd(0, 1, 2, 3), _mm256_set1_pd(count), _CMP_LT_OQ)};
}
/// One bit per lane.
inline unsigned Bits(Mask m) {
  return static_cast<unsigned>(_mm256_movemask_pd(m.v));
}

struct Words {
  __m256i v;
};
inline Words LoadWords(const std::uint64_t* p) {
  return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
}
inline void StoreWords(std::uint64_t* p, Words a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a.v);
}
inline Words AllWords(std::uint64_t s) {
  return {_mm256_set1_epi64x(static_cast<long long>(s))};
}
inline Words WordsOf(Pack a) {
  return {_mm256_castpd_si256(a.v)};
}
inline Words operator&(Words a, Words b) {
  return {_mm256_and_si256(a.v, b.v)};
}
inline Words operator^(Words a, Words b) {
  return {_mm256_xor_si256(a.v, b.v)};
}
inline Words operator|(Words a, Words b) {
  return {_mm256_or_si256(a.v, b.v)};
}
template <int bits>
inline Words Down(Words a) {
  return {_mm256_srli_epi64(a.v, bits)};
}
template <int bits>
inline Words Up(Words a) {
  return {_mm256_slli_epi64(a.v, bits)};
}
inline Words Quarters(Words x, Words y, Words z) {
  const __m256i xy = _mm256_blend_epi16(_mm256_srli_epi64(x.v, 14), _mm256_slli_epi64(y.v, 2), 0x22);
  return {_mm256_blend_epi16(xy, _mm256_slli_epi64(z.v, 18), 0x44)};
}
inline Words TimesQuarters(Words a, Words b) {
  return {_mm256_mulhi_epu16(a.v, b.v)};
}
inline Words ExtremeQuarters(Words a) {
  const __m256i next = _mm256_sub_epi16(a.v, _mm256_set1_epi16(-1));
  return {_mm256_cmpeq_epi16(_mm256_min_epu16(next, _mm256_set1_epi16(1)), next)};
}
inline unsigned Differ(Words a, Words b) {
  return ~Bits(Mask{_mm256_castsi256_pd(_mm256_cmpeq_epi64(a.v, b.v))}) & 15;
}
inline Pack Gather(const double* from, const std::int32_t* index) {
  return {_mm256_setr_pd(from[index[0]], from[index[1]], from[index[2]], from[index[3]])};
}
inline Pack MaybeFused(Pack a, Pack b, Pack c) {
  return {_mm256_fmadd_pd(a.v, b.v, c.v)};
}
inline std::uint64_t NonzeroBytes(const std::uint8_t* p) {
  std::uint64_t zeros = 0;
  for (int half = 0; half < 2; ++half) {
    const __m256i bytes = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p) + half);
    const int bits = _mm256_movemask_epi8(_mm256_cmpeq_epi8(bytes, _mm256_setzero_si256()));
    zeros |= std::uint64_t{static_cast<std::uint32_t>(bits)} << 32 * half;
  }
  return ~zeros;
}
constexpr bool kQuickRoots = false;
inline bool QuickSqrt(const Pack[6], Pack[6]) {
  return false;
}
