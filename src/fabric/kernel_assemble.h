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

/// Blocks of a row that are summed at once; most rows have fewer.
constexpr int kRowBlocks = 8;

/// Blocks [begin, begin + kRowBlocks) of a row, and what does not count in the last. Returns the sum of all blocks off
/// the diagonal.
inline Columns SumCorners(const AssembleArgs& a, int row, std::uint32_t begin, Columns (&blocks)[kRowBlocks + 1]) {
  Columns sum;
  const auto add = [&](const Columns& block, std::uint16_t slot) {
    sum += block;
    const std::uint32_t place = slot - begin;
    blocks[place < kRowBlocks ? place : kRowBlocks] += block;
  };
  for (std::int32_t e = a.cornerFirst[row]; e < a.cornerFirst[row + 1]; ++e) {
    const std::int32_t triangle = a.corner[e] / 3, corner = a.corner[e] - 3 * triangle;
    const std::int32_t ahead = triangle - a.firstTriangle;
    const Real* hessian =
        a.hessian + kHessianReals * static_cast<std::int64_t>(ahead < a.triangles ? ahead : ahead - a.triangles);
    add(LoadColumns(hessian + 9 * corner), a.slot[2 * static_cast<std::int64_t>(e)]);
    add(Transposed(LoadColumns(hessian + 9 * (corner == 0 ? 2 : corner - 1))),
        a.slot[2 * static_cast<std::int64_t>(e) + 1]);
  }
  return sum;
}

void Assemble(const AssembleArgs& a) {
  for (int row = a.begin; row < a.end; ++row) {
    const std::int32_t diagonal = a.storedFirst[row];
    const auto count = static_cast<std::uint32_t>(a.storedFirst[row + 1] - diagonal);
    for (std::uint32_t begin = 0; begin < count; begin += kRowBlocks) {
      Columns blocks[kRowBlocks + 1];
      Columns sum = SumCorners(a, row, begin, blocks);
      if (begin == 0) {
        for (int k = 0; k < 3; ++k) blocks[0].c[k] = -sum.c[k];
      }
      for (std::uint32_t k = 0; k < kRowBlocks && begin + k < count; ++k) {
        const std::int64_t at = diagonal + static_cast<std::int64_t>(begin + k);
        StoreBlock(blocks[k], a.constant[at], a.blocks + 9 * at);
      }
    }
  }
}
