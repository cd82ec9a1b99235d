// Which boxes of a block are near a box. Included by kernels_impl.h inside the namespace of an instruction set, like
// everything there; never elsewhere.

// Two boxes are apart if along one axis one is below the other at the start and at the end: for what moves along
// straight lines in common time keeps that in between. One is below the other where its extent upward and the other's
// downward have a negative sum; signs of sums are the same on all processors. No sum is -0: extents are rounded up, and
// are never -0 themselves.

/// The box at that place, whose extents are kLanes apart.
inline const float* BoxAt(const BoxBlock* blocks, int index) {
  return blocks[index / kLanes].extent[0] + index % kLanes;
}

/// Eight boxes, in registers.
class EightBoxes {
 public:
#if defined(__AVX2__)
  explicit EightBoxes(const BoxBlock& block) {
    for (int i = 0; i < 12; ++i) extent_[i] = _mm256_load_ps(block.extent[i]);
  }
  /// A bit for each of them that is near.
  unsigned Near(const float* box) const {
    __m256 apart = _mm256_setzero_ps();
    for (int i = 0; i < 3; ++i) {
      apart = OrBoth(apart, Sum(i, box, i + 6), Sum(i + 3, box, i + 9));
      apart = OrBoth(apart, Sum(i + 6, box, i), Sum(i + 9, box, i + 3));
    }
    return static_cast<unsigned>(_mm256_movemask_ps(apart)) ^ 0xff;
  }

 private:
  __m256 Sum(int i, const float* box, int k) const {
    return _mm256_add_ps(extent_[i], _mm256_set1_ps(box[k * kLanes]));
  }
  /// a | (b & c)
  static __m256 OrBoth(__m256 a, __m256 b, __m256 c) {
#if defined(__AVX512VL__)
    return _mm256_castsi256_ps(
        _mm256_ternarylogic_epi32(_mm256_castps_si256(a), _mm256_castps_si256(b), _mm256_castps_si256(c), 0xf8));
#else
    return _mm256_or_ps(a, _mm256_and_ps(b, c));
#endif
  }
  __m256 extent_[12];
#elif defined(__SSE2__)
  explicit EightBoxes(const BoxBlock& block) : block_(block) {}
  /// A bit for each of them that is near.
  unsigned Near(const float* box) const {
    unsigned apart[2];
    for (int half = 0; half < 2; ++half) {
      const auto sum = [&](int i, int k) {
        return _mm_add_ps(_mm_load_ps(block_.extent[i] + 4 * half), _mm_set1_ps(box[k * kLanes]));
      };
      __m128 any = _mm_setzero_ps();
      for (int i = 0; i < 3; ++i) {
        any = _mm_or_ps(any, _mm_and_ps(sum(i, i + 6), sum(i + 3, i + 9)));
        any = _mm_or_ps(any, _mm_and_ps(sum(i + 6, i), sum(i + 9, i + 3)));
      }
      apart[half] = static_cast<unsigned>(_mm_movemask_ps(any));
    }
    return (apart[0] | apart[1] << 4) ^ 0xff;
  }

 private:
  const BoxBlock& block_;
#else
  explicit EightBoxes(const BoxBlock& block) : block_(block) {}
  /// A bit for each of them that is near.
  unsigned Near(const float* box) const {
    unsigned near = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto isBelow = [&](int i, int k) { return block_.extent[i][lane] + box[k * kLanes] < 0; };
      bool apart = false;
      for (int i = 0; i < 3; ++i) {
        apart |= isBelow(i, i + 6) && isBelow(i + 3, i + 9);
        apart |= isBelow(i + 6, i) && isBelow(i + 9, i + 3);
      }
      near |= (apart ? 0u : 1u) << lane;
    }
    return near;
  }

 private:
  const BoxBlock& block_;
#endif
};

/// For each set of lanes, which they are and how many.
struct LaneTable {
  std::uint8_t lanes[256][kLanes];
  std::uint8_t count[256];

  constexpr LaneTable() : lanes(), count() {
    for (int set = 0; set < 256; ++set) {
      for (int lane = 0; lane < kLanes; ++lane) {
        if ((set >> lane & 1) != 0) lanes[set][count[set]++] = static_cast<std::uint8_t>(lane);
      }
    }
  }
};
constexpr LaneTable kLaneTable;

inline int LaneCount(unsigned lanes) {
#if defined(__POPCNT__)
  return __builtin_popcount(lanes);
#else
  return kLaneTable.count[lanes];
#endif
}

/// Numbers that are added to without a branch, since nobody can predict how many lanes are set. Writes whole blocks.
inline void PutLanes(std::uint8_t* to, unsigned lanes, int first) {
  std::uint64_t bytes;
  memcpy(&bytes, kLaneTable.lanes[lanes], sizeof bytes);
  bytes += static_cast<std::uint64_t>(first) * 0x0101010101010101u;
  memcpy(to, &bytes, sizeof bytes);
}
inline void PutSame(std::uint8_t* to, int number) {
  const std::uint64_t bytes = static_cast<std::uint64_t>(number) * 0x0101010101010101u;
  memcpy(to, &bytes, sizeof bytes);
}
