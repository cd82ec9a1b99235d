// Eight doubles at a time, with AVX-512. Included by pack.h inside the namespace of an instruction set; never
// elsewhere.

constexpr int kLanes = 8;

struct Pack {
  __m512d v;
};
struct Mask {
  __mmask8 v;
};
inline Pack Load(const double* p) {
  return {_mm512_loadu_pd(p)};
}
inline void Store(double* p, Pack a) {
  _mm512_storeu_pd(p, a.v);
}
inline Pack All(double s) {
  return {_mm512_set1_pd(s)};
}
inline Pack operator+(Pack a, Pack b) {
  return {_mm512_add_pd(a.v, b.v)};
}
inline Pack operator-(Pack a, Pack b) {
  return {_mm512_sub_pd(a.v, b.v)};
}
inline Pack operator*(Pack a, Pack b) {
  return {_mm512_mul_pd(a.v, b.v)};
}
inline Pack operator/(Pack a, Pack b) {
  return {_mm512_div_pd(a.v, b.v)};
}
inline Pack Sqrt(Pack a) {
  return {_mm512_sqrt_pd(a.v)};
}
inline Mask operator>(Pack a, Pack b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)};
}
inline Mask operator<=(Pack a, Pack b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ)};
}
inline Mask operator&(Mask a, Mask b) {
  return {static_cast<__mmask8>(a.v & b.v)};
}
inline Mask operator|(Mask a, Mask b) {
  return {static_cast<__mmask8>(a.v | b.v)};
}
inline Mask operator^(Mask a, Mask b) {
  return {static_cast<__mmask8>(a.v ^ b.v)};
}
/// `a` where the mask is set, else `b`.
inline Pack Select(Mask m, Pack a, Pack b) {
  return {_mm512_mask_mov_pd(b.v, m.v, a.v)};
}
/// `a` where the mask is set, else zero.
inline Pack Where(Mask m, Pack a) {
  return {_mm512_maskz_mov_pd(m.v, a.v)};
}
inline Pack Max(Pack a, Pack b) {
  return {_mm512_max_pd(a.v, b.v)};
}
/// Lanes that are farther from zero than the bound, or not a number.
inline Mask Outside(Pack a, double bound) {
  return {_mm512_cmp_pd_mask(_mm512_abs_pd(a.v), _mm512_set1_pd(bound), _CMP_NLE_UQ)};
}
/// The lanes before `count`, which is at most kLanes.
inline Mask FirstLanes(int count) {
  return {static_cast<__mmask8>((1u << count) - 1)};
}
/// One bit per lane.
inline unsigned Bits(Mask m) {
  return m.v;
}

/// As many whole numbers of 64 bits.
struct Words {
  __m512i v;
};
inline Words LoadWords(const std::uint64_t* p) {
  return {_mm512_loadu_si512(p)};
}
inline void StoreWords(std::uint64_t* p, Words a) {
  _mm512_storeu_si512(p, a.v);
}
inline Words AllWords(std::uint64_t s) {
  return {_mm512_set1_epi64(static_cast<long long>(s))};
}
inline Words WordsOf(Pack a) {
  return {_mm512_castpd_si512(a.v)};
}
inline Words operator&(Words a, Words b) {
  return {_mm512_and_si512(a.v, b.v)};
}
inline Words operator^(Words a, Words b) {
  return {_mm512_xor_si512(a.v, b.v)};
}
inline Words operator|(Words a, Words b) {
  return {_mm512_or_si512(a.v, b.v)};
}
template <int bits>
inline Words Down(Words a) {
  return {_mm512_srli_epi64(a.v, bits)};
}
template <int bits>
inline Words Up(Words a) {
  return {_mm512_slli_epi64(a.v, bits)};
}
/// Bits 14 to 29 of x, y and z, side by side from the lowest bit on, and above them the two highest of x.
inline Words Quarters(Words x, Words y, Words z) {
  const __m512i xy = _mm512_mask_blend_epi16(0x22222222, _mm512_srli_epi64(x.v, 14), _mm512_slli_epi64(y.v, 2));
  return {_mm512_mask_blend_epi16(0x44444444, xy, _mm512_slli_epi64(z.v, 18))};
}
/// The products of quarters, less their lower half.
inline Words TimesQuarters(Words a, Words b) {
  return {_mm512_mulhi_epu16(a.v, b.v)};
}
/// All bits of those quarters whose bits are all the same, else none.
inline Words ExtremeQuarters(Words a) {
  const __m512i next = _mm512_sub_epi16(a.v, _mm512_set1_epi16(-1));
  return {_mm512_movm_epi16(_mm512_cmple_epu16_mask(next, _mm512_set1_epi16(1)))};
}
/// One bit per lane.
inline unsigned Differ(Words a, Words b) {
  return _mm512_cmpneq_epi64_mask(a.v, b.v);
}
/// from[index[lane]].
inline Pack Gather(const double* from, const std::int32_t* index) {
  return {_mm512_setr_pd(from[index[0]], from[index[1]], from[index[2]], from[index[3]], from[index[4]], from[index[5]],
                         from[index[6]], from[index[7]])};
}
/// a b + c, rounded once or twice: for tests that leave room for either.
inline Pack MaybeFused(Pack a, Pack b, Pack c) {
  return {_mm512_fmadd_pd(a.v, b.v, c.v)};
}
/// A bit for each of 64 bytes that is not zero.
inline std::uint64_t NonzeroBytes(const std::uint8_t* p) {
  const __m512i bytes = _mm512_loadu_si512(p);
  return _mm512_test_epi8_mask(bytes, bytes);
}
/// Six roots side by side, each rounded correctly as by Sqrt. Half of them come without the divider, which
/// else would take longer than all other work on a spring. Returns false, and no roots, where that is
/// not to be had.
///
/// Two rounds of Goldschmidt's iteration take root and 1 / (2 root) to within 2^-51 of their size; the
/// residual a - root^2 is exact; so the last sum is off by less than 2^-100 before it is rounded. It could
/// be rounded wrongly only where the true root is as near to the midpoint of two doubles (Cornea, Harrison
/// and Tang 2002, "Scientific Computing on Itanium-based Systems", chapter 7: exclusion zones). The test goes
/// through the nearest ones; the root of the first double after a power of four, the hardest, is left to
/// the divider.
constexpr bool kQuickRoots = true;
inline bool QuickSqrt(const Pack a[6], Pack roots[6]) {
  constexpr int kQuick = 3;  // 0 to 2 and 4 to 6 are 5 to 15 % slower, on Zen 4
  // Residuals of quick roots between these do not underflow. Least and greatest leave the multipliers free, which
  // comparisons do not.
  constexpr __mmask8 kAll = 0xff;  // without a mask, gcc 12 warns of what its headers leave undefined
  __m512d least = a[0].v, greatest = a[0].v;
  for (int s = 1; s < kQuick; ++s) {
    least = _mm512_maskz_min_pd(kAll, least, a[s].v);
    greatest = _mm512_maskz_max_pd(kAll, greatest, a[s].v);
  }
  unsigned outside = _mm512_cmp_pd_mask(least, _mm512_set1_pd(0x1p-900), _CMP_NGE_UQ);
  outside |= _mm512_cmp_pd_mask(greatest, _mm512_set1_pd(0x1p900), _CMP_NLE_UQ);
  const __m512i part = _mm512_set1_epi64((1LL << 52) - 1), first = _mm512_set1_epi64(1);
  for (int s = 0; s < kQuick; ++s) {
    outside |= _mm512_cmpeq_epi64_mask(_mm512_and_si512(_mm512_castpd_si512(a[s].v), part), first);
  }
  if (outside != 0) return false;
  const __m512d half = _mm512_set1_pd(0.5);
  __m512d root[kQuick], halfInverse[kQuick], error[kQuick];
  for (int s = kQuick; s < 6; ++s) roots[s] = Sqrt(a[s]);
  for (int s = 0; s < kQuick; ++s) halfInverse[s] = _mm512_rsqrt14_pd(a[s].v);
  for (int s = 0; s < kQuick; ++s) root[s] = _mm512_mul_pd(a[s].v, halfInverse[s]);
  for (int s = 0; s < kQuick; ++s) halfInverse[s] = _mm512_mul_pd(half, halfInverse[s]);
  for (int iteration = 0; iteration < 2; ++iteration) {
    for (int s = 0; s < kQuick; ++s) error[s] = _mm512_fnmadd_pd(root[s], halfInverse[s], half);
    for (int s = 0; s < kQuick; ++s) root[s] = _mm512_fmadd_pd(root[s], error[s], root[s]);
    for (int s = 0; s < kQuick; ++s) halfInverse[s] = _mm512_fmadd_pd(halfInverse[s], error[s], halfInverse[s]);
  }
  for (int s = 0; s < kQuick; ++s) error[s] = _mm512_fnmadd_pd(root[s], root[s], a[s].v);
  for (int s = 0; s < kQuick; ++s) roots[s] = {_mm512_fmadd_pd(error[s], halfInverse[s], root[s])};
  return true;
}
