// Pairs as four vertices each. Included by kernels_impl.h inside the namespace of an instruction set, like everything
// there; never elsewhere.

// All are written, and the next one over those with a vertex in common: without a branch, since nobody can predict
// them.

#if defined(__SSE2__)
inline int WriteVertexTriangle(const WriteArgs& a) {
  const int count = a.count;  // what is written could be these, for all that the compiler knows
  const std::uint8_t *numberA = a.numberA, *numberB = a.numberB;
  const std::int32_t *vertices = a.a, *triangles = a.b;
  std::int32_t* to = a.to;
  for (int k = 0; k < count; ++k) {
    const std::int32_t* triangle = triangles + 3 * numberB[k];
    const __m128i v = _mm_cvtsi32_si128(vertices[numberA[k]]);
    const __m128i corners = _mm_unpacklo_epi64(_mm_loadu_si64(triangle), _mm_cvtsi32_si128(triangle[2]));
    const __m128i quad = _mm_or_si128(_mm_slli_si128(corners, 4), v);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), quad);
    const __m128i same = _mm_cmpeq_epi32(quad, _mm_shuffle_epi32(v, 0));
    to += _mm_movemask_ps(_mm_castsi128_ps(same)) == 1 ? 4 : 0;
  }
  return static_cast<int>(to - a.to) / 4;
}

inline int WriteEdgeEdge(const WriteArgs& a) {
  const int count = a.count;
  const std::uint8_t *numberA = a.numberA, *numberB = a.numberB;
  const std::int32_t *edgesA = a.a, *edgesB = a.b;
  std::int32_t* to = a.to;
  for (int k = 0; k < count; ++k) {
    const __m128i first = _mm_loadu_si64(edgesA + 2 * numberA[k]), second = _mm_loadu_si64(edgesB + 2 * numberB[k]);
    const __m128i quad = _mm_unpacklo_epi64(first, second), other = _mm_unpacklo_epi64(second, first);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), quad);
    const __m128i turned = _mm_shuffle_epi32(other, _MM_SHUFFLE(2, 3, 0, 1));
    const __m128i same = _mm_or_si128(_mm_cmpeq_epi32(quad, other), _mm_cmpeq_epi32(quad, turned));
    to += _mm_movemask_ps(_mm_castsi128_ps(same)) == 0 ? 4 : 0;
  }
  return static_cast<int>(to - a.to) / 4;
}
#else
inline int WriteVertexTriangle(const WriteArgs& a) {
  int written = 0;
  for (int k = 0; k < a.count; ++k) {
    const std::int32_t* triangle = a.b + 3 * a.numberB[k];
    const std::int32_t v = a.a[a.numberA[k]];
    std::int32_t* to = a.to + 4 * written;
    to[0] = v, to[1] = triangle[0], to[2] = triangle[1], to[3] = triangle[2];
    written += ((to[1] == v) | (to[2] == v) | (to[3] == v)) != 0 ? 0 : 1;
  }
  return written;
}

inline int WriteEdgeEdge(const WriteArgs& a) {
  int written = 0;
  for (int k = 0; k < a.count; ++k) {
    const std::int32_t *e = a.a + 2 * a.numberA[k], *f = a.b + 2 * a.numberB[k];
    std::int32_t* to = a.to + 4 * written;
    to[0] = e[0], to[1] = e[1], to[2] = f[0], to[3] = f[1];
    written += ((e[0] == f[0]) | (e[0] == f[1]) | (e[1] == f[0]) | (e[1] == f[1])) != 0 ? 0 : 1;
  }
  return written;
}
#endif
