// Forces of plates. Included by kernels_impl.h inside the namespace of an instruction set; never elsewhere.

/// Sums of scaled ways from one place to others, and of their scaled squares.
#if defined(__AVX2__)
class WaySums {
 public:
  explicit WaySums(const Vec3& from) : from_(Load(from)) {}
  void Add(double scale, const Vec3& to) {
    const __m256d way = _mm256_sub_pd(Load(to), from_), scaled = _mm256_mul_pd(_mm256_set1_pd(scale), way);
    sum_ = _mm256_add_pd(sum_, scaled);
    squares_ = _mm256_add_pd(squares_, _mm256_mul_pd(scaled, way));
  }
  void StoreSum(Vec3& to) const { Store(sum_, to); }
  double Squares() const {
    Vec3 parts;
    Store(squares_, parts);
    return parts.x + parts.y + parts.z;
  }

 private:
  static __m256d Load(const Vec3& v) { return _mm256_maskload_pd(&v.x, _mm256_setr_epi64x(-1, -1, -1, 0)); }
  static void Store(__m256d xyz, Vec3& to) {
    _mm_storeu_pd(&to.x, _mm256_castpd256_pd128(xyz));
    _mm_store_sd(&to.z, _mm256_extractf128_pd(xyz, 1));
  }

  __m256d from_, sum_ = _mm256_setzero_pd(), squares_ = _mm256_setzero_pd();
};
#else
class WaySums {
 public:
  explicit WaySums(const Vec3& from) : from_(from) {}
  void Add(double scale, const Vec3& to) {
    const double x = to.x - from_.x, y = to.y - from_.y, z = to.z - from_.z;
    const double sx = scale * x, sy = scale * y, sz = scale * z;
    sum_.x += sx, sum_.y += sy, sum_.z += sz;
    squares_.x += sx * x, squares_.y += sy * y, squares_.z += sz * z;
  }
  void StoreSum(Vec3& to) const { to.x = sum_.x, to.y = sum_.y, to.z = sum_.z; }
  double Squares() const { return squares_.x + squares_.y + squares_.z; }

 private:
  Vec3 from_, sum_, squares_;
};
#endif

double PlateForces(const PlateArgs& a) {
  double squares = 0;
  for (int v = a.begin; v < a.end; ++v) {
    if (!a.isPlate[v]) continue;
    const SharedRowsView<double>& rows = a.rows;
    const std::int32_t kind = rows.kind[v];
    const Vec3* const at = a.x + v;
    WaySums ways(*at);
    for (std::int32_t k = rows.first[kind]; k < rows.first[kind + 1]; ++k) ways.Add(rows.value[k], at[rows.offset[k]]);
    ways.StoreSum(a.force[v]);
    squares += ways.Squares();
  }
  return squares;
}
