// Products of the matrix with a vector. Included by kernels_impl.h inside the namespace of an instruction set; never
// elsewhere.

/// A sum of products of blocks, and of transposes of blocks, with vectors of three. The products of the nine numbers
/// are summed apart and added up at the end, on all processors in the same order.
#if defined(__AVX2__)
class BlockSum {
 public:
  void Add(const Real* block, const Real* v) {
    const __m256i eight = _mm256_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2);
    first_ = _mm256_add_ps(first_, _mm256_mul_ps(_mm256_loadu_ps(block), Spread(v, eight)));
    last_ += block[8] * v[2];
  }
  void AddTransposed(const Real* block, const Real* v) {
    const __m256i eight = _mm256_setr_epi32(0, 1, 2, 0, 1, 2, 0, 1);
    transposedFirst_ = _mm256_add_ps(transposedFirst_, _mm256_mul_ps(_mm256_loadu_ps(block), Spread(v, eight)));
    transposedLast_ += block[8] * v[2];
  }
  Floats4 Total() const {
    const __m256i fromThree = _mm256_setr_epi32(3, 4, 5, 6, 6, 6, 6, 6);
    const __m128 column0 = _mm256_castps256_ps128(first_);
    const __m128 column1 = _mm256_castps256_ps128(_mm256_permutevar8x32_ps(first_, fromThree));
    const __m128 column2 = _mm_shuffle_ps(_mm256_extractf128_ps(first_, 1), _mm_set_ss(last_), _MM_SHUFFLE(1, 0, 3, 2));
    const __m128 row0 = Every3(_mm256_setr_epi32(0, 3, 6, 6, 6, 6, 6, 6));
    const __m128 row1 = Every3(_mm256_setr_epi32(1, 4, 7, 7, 7, 7, 7, 7));
    const __m128 row2 = _mm_insert_ps(Every3(_mm256_setr_epi32(2, 5, 5, 5, 5, 5, 5, 5)), _mm_set_ss(transposedLast_),
                                      0x20);  // to the third place
    return Floats4(
        _mm_add_ps(_mm_add_ps(_mm_add_ps(column0, column1), column2), _mm_add_ps(_mm_add_ps(row0, row1), row2)));
  }

 private:
  static __m256 Spread(const Real* v, __m256i places) {
    return _mm256_permutevar8x32_ps(_mm256_castps128_ps256(_mm_loadu_ps(v)), places);
  }
  __m128 Every3(__m256i places) const {
    return _mm256_castps256_ps128(_mm256_permutevar8x32_ps(transposedFirst_, places));
  }

  __m256 first_ = _mm256_setzero_ps(), transposedFirst_ = _mm256_setzero_ps();
  Real last_ = 0, transposedLast_ = 0;
};
#else
class BlockSum {
 public:
  void Add(const Real* block, const Real* v) {
    for (int c = 0; c < 3; ++c) sum_.c[c] += Floats4::Load(block + 3 * c) * Floats4(v[c]);
  }
  void AddTransposed(const Real* block, const Real* v) {
    for (int c = 0; c < 3; ++c) transposed_.c[c] += Floats4::Load(block + 3 * c) * Floats4::Load(v);
  }
  Floats4 Total() const {
    const Columns rows = Transposed(transposed_);
    return (sum_.c[0] + sum_.c[1] + sum_.c[2]) + (rows.c[0] + rows.c[1] + rows.c[2]);
  }

 private:
  Columns sum_, transposed_;
};
#endif

inline void AddExtra(const RowsArgs& a, int row, BlockSum& sum) {
  for (std::int32_t e = a.extraBegin[row]; e < a.extraEnd[row]; ++e) {
    sum.Add(a.extraBlocks + 9 * static_cast<std::int64_t>(e), a.x + 3 * static_cast<std::int64_t>(a.extraColumn[e]));
  }
}

/// Calls store(row + r, H x at that row) for every r: rows whose columns and constants are alike, so that where to look
/// is found once for all. Sums by fold expressions: those of a loop would go through memory.
template <int... r, class Store>
inline void MultiplyAlike(const RowsArgs& a, int row, std::integer_sequence<int, r...>, Store&& store) {
  BlockSum sum[sizeof...(r)];
  const Real* const at = a.x + 3 * static_cast<std::int64_t>(row);
  const std::int32_t columns = a.columns.kind[row], end = a.columns.first[columns + 1];
  std::int32_t k = a.columns.first[columns];
  for (; a.columns.offset[k] < 0; ++k) {
    const std::int64_t offset = a.columns.offset[k], mirrored = a.columns.value[k];
    const std::int32_t* const first = a.storedFirst + row + offset;
    (sum[r].AddTransposed(a.blocks + 9 * (first[r] + mirrored), at + 3 * (offset + r)), ...);
  }
  const Real* block = a.blocks + 9 * static_cast<std::int64_t>(a.storedFirst[row]);
  const std::int64_t stored = end - k;
  for (; k < end; ++k, block += 9) {
    const std::int64_t offset = a.columns.offset[k];
    (sum[r].Add(block + 9 * r * stored, at + 3 * (offset + r)), ...);
  }
  if (a.extraBlocks) (AddExtra(a, row + r, sum[r]), ...);
  Floats4 rest[sizeof...(r)];
  const std::int32_t constant = a.constant.kind[row];
  for (std::int64_t e = a.constant.first[constant] + stored - 1; e < a.constant.first[constant + 1]; ++e) {
    const std::int64_t offset = a.constant.offset[e];
    const Floats4 value(a.constant.value[e]);
    ((rest[r] += Floats4::Load(at + 3 * (offset + r)) * value), ...);
  }
  (store(row + r, sum[r].Total() + rest[r]), ...);
}

/// Calls store(row, H x at that row) for each row.
template <class Store>
inline void ForRows(const RowsArgs& a, Store&& store) {
  const auto alike = [&](int row, int other) {
    return a.columns.kind[row] == a.columns.kind[other] && a.constant.kind[row] == a.constant.kind[other];
  };
  for (int row = a.begin; row < a.end;) {
    if (row + 1 < a.end && alike(row, row + 1)) {
      MultiplyAlike(a, row, std::integer_sequence<int, 0, 1>(), store);
      row += 2;
    } else {
      MultiplyAlike(a, row, std::integer_sequence<int, 0>(), store);
      ++row;
    }
  }
}

double Multiply(const RowsArgs& a) {
  double dot = 0;
  ForRows(a, [&](int row, Floats4 s) {
    const std::int64_t at = 3 * static_cast<std::int64_t>(row);
    double product = 0;
    for (int r = 0; r < 3; ++r) {
      a.y[at + r] = s[r];
      product += static_cast<double>(a.x[at + r]) * static_cast<double>(s[r]);
    }
    dot += product;
  });
  return dot;
}

void Residual(const RowsArgs& a) {
  ForRows(a, [&](int row, Floats4 s) {
    const std::int64_t at = 3 * static_cast<std::int64_t>(row);
    for (int r = 0; r < 3; ++r) a.y[at + r] = a.right[at + r] - s[r];
  });
}

void Smooth(const RowsArgs& a) {
  ForRows(a, [&](int row, Floats4 s) {
    const std::int64_t at = 3 * static_cast<std::int64_t>(row);
    const Real* inverse = a.inverse + 3 * at;
    Floats4 step;
    for (int c = 0; c < 3; ++c) step += Floats4::Load(inverse + 3 * c) * Floats4(a.right[at + c] - s[c]);
    for (int r = 0; r < 3; ++r) a.y[at + r] = a.x[at + r] + a.omega * step[r];
  });
}
