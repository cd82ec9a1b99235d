// The blocks of the matrix from those of the triangles. Included by kernels_impl.h inside the namespace of an
// instruction set; never elsewhere.

using Floats4 = Pack<Real, 4, Level>;

/// A block's columns, each with one number behind it that does not count.
struct Columns {
  Floats4 c[3];

  Columns& operator+=(const Columns& o) {
    for (int k = 0; k < 3; ++k) c[k] += o.c[k];
    return *this;
  }
};
inline Columns LoadColumns(const Real* block) {
  return {{Floats4::Load(block), Floats4::Load(block + 3), Floats4::Load(block + 6)}};
}
inline Columns Transposed(const Columns& a) {
#if defined(__GNUC__)
  const auto low = __builtin_shufflevector(a.c[0].v, a.c[1].v, 0, 4, 1, 5);
  const auto high = __builtin_shufflevector(a.c[0].v, a.c[1].v, 2, 6, 3, 7);
  return {{Floats4(__builtin_shufflevector(low, a.c[2].v, 0, 1, 4, 7)),
           Floats4(__builtin_shufflevector(low, a.c[2].v, 2, 3, 5, 7)),
           Floats4(__builtin_shufflevector(high, a.c[2].v, 0, 1, 6, 7))}};
#else
  Columns b;
  for (int k = 0; k < 9; ++k) b.c[k / 3].v[k % 3] = a.c[k % 3].v[k / 3];
  return b;
#endif
}
/// `a` plus `s` on the diagonal.
inline void StoreBlock(Columns a, Real s, Real* block) {
  constexpr Real kUnit[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  for (int k = 0; k < 3; ++k) a.c[k] += Floats4::Load(kUnit[k]) * Floats4(s);
  a.c[0].Store(block);
  a.c[1].Store(block + 3);
  for (int r = 0; r < 3; ++r) block[6 + r] = a.c[2][r];
}

template <class Code>
void AssembleBy(const AssembleArgs& a, const Code* codes) {
  for (int row = a.begin; row < a.end; ++row) {
    Columns sum;
    Real* const stored = a.blocks + 9 * static_cast<std::int64_t>(a.storedFirst[row]);
    Real* next = stored + 9;
    const Real* constant = a.constant.value + a.constant.first[a.constant.kind[row]];
    const std::int32_t* const corners = a.corner + a.cornerFirst[row];
    const Code* code = codes + 2 * static_cast<std::int64_t>(a.cornerFirst[row]);
    const std::int32_t columns = a.columns.kind[row];
    for (std::int32_t k = a.columns.first[columns]; k < a.columns.first[columns + 1]; ++k) {
      if (a.columns.offset[k] == 0) continue;
      Columns block;
      for (bool last = false; !last; ++code) {
        last = (*code & 1) != 0;
        std::int32_t place = corners[*code >> 3] - a.cornersBegin;
        if (place < 0) place += a.corners;
        const Real* own = a.hessian + 9 * static_cast<std::int64_t>(place);
        const int from = *code >> 1 & 3;
        if (from == 0)
          block += LoadColumns(own);
        else
          block += Transposed(LoadColumns(from == 1 ? own - 9 : own + 18));
      }
      sum += block;
      if (a.columns.offset[k] < 0) continue;
      StoreBlock(block, *constant++, next);
      next += 9;
    }
    for (Floats4& c : sum.c) c = -c;
    StoreBlock(sum, a.diagonal[row], stored);
  }
}

void Assemble(const AssembleArgs& a) {
  if (a.parts)
    AssembleBy(a, a.parts);
  else
    AssembleBy(a, a.wideParts);
}
